#pragma once

#include <string>
#include <vector>

namespace spelunk {

/// Whether a user means the path of a file, not a name from a folder of ours: there is a folder or
/// an ending in it.
[[nodiscard]] bool looksLikePath(const std::string& text);

/// The file that a user's path means: as it is if it is absolute or begins with "~/", else seen
/// from the first of `folders` that has it; an empty folder is the current one. `what` names the
/// kind of file in the message. Throws OutsideError with every path that was tried.
[[nodiscard]] std::string existingFile(const std::string& what, const std::string& path,
                                       const std::vector<std::string>& folders);

}  // namespace spelunk
