#pragma once

namespace spelunk {

/// Makes sin, exp and their kin give the same bits on every x86-64 processor. glibc picks variants
/// with fused multiply-add where the processor has it, and those round differently; the choice is
/// made before main. So this restarts the program once, in the same process, with GLIBC_TUNABLES
/// telling glibc to leave them out. Call it first in a main whose results must repeat.
///
/// Returns at once where there is nothing to pin (already restarted, no such instructions, other
/// C library). Where the restart fails it warns and goes on: results are right, but may differ in
/// the last digit from another machine's.
void pinMathLibrary(int argc, char** argv);

}  // namespace spelunk
