#pragma once

#include <optional>
#include <string>
#include <vector>

namespace spelunk::evaluation {

/// Runs a program with its list of arguments, the program's path first, and waits for it. No shell
/// reads them, so any character may be in them. What it prints on stdout is dropped. Returns its
/// exit code; none if it could not be started or was killed. Throws Precondition if the list is
/// empty.
[[nodiscard]] std::optional<int> runProgram(const std::vector<std::string>& arguments);

}  // namespace spelunk::evaluation
