#include "run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "spelunk/common/contract.h"

namespace spelunk::evaluation {
namespace {

std::optional<int> exitCodeOf(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return std::nullopt;
  if (!WIFEXITED(status)) return std::nullopt;
  return WEXITSTATUS(status);
}

}  // namespace

std::optional<int> runProgram(const std::vector<std::string>& arguments) {
  require(!arguments.empty(), "runProgram: no program");
  std::vector<char*> texts;
  for (const std::string& text : arguments) texts.push_back(const_cast<char*>(text.c_str()));
  texts.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int failure =
      posix_spawn(&process, texts.front(), &actions, nullptr, texts.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failure == 0 ? exitCodeOf(process) : std::nullopt;
}

}  // namespace spelunk::evaluation
