#include "spelunk/common/pin_math.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

#include "spelunk/common/log.h"

namespace spelunk {
namespace {

constexpr const char* kVariable = "GLIBC_TUNABLES";
/// The names since glibc 2.33 and those before it; a name it does not know is ignored.
constexpr const char* kSetting = "glibc.cpu.hwcaps=-FMA,-FMA4,-FMA_Usable,-FMA4_Usable";

bool hasVariantsToAvoid() {
#if defined(__x86_64__) && defined(__GLIBC__)
  return __builtin_cpu_supports("fma") != 0 || __builtin_cpu_supports("fma4") != 0;
#else
  return false;
#endif
}

}  // namespace

void pinMathLibrary(int argc, char** argv) {
  if (argc < 1 || !hasVariantsToAvoid()) return;
  const char* present = std::getenv(kVariable);
  std::string tunables = present == nullptr ? "" : present;
  if (tunables.find(kSetting) != std::string::npos) return;
  if (!tunables.empty()) tunables += ":";
  tunables += kSetting;
  if (setenv(kVariable, tunables.c_str(), 1) == 0) execv("/proc/self/exe", argv);
  log(LogLevel::kWarn,
      "cannot restart with a pinned mathematical library; runs may differ in the last digit from "
      "those of other machines. Remedy: start with GLIBC_TUNABLES=" +
          std::string(kSetting));
}

}  // namespace spelunk
