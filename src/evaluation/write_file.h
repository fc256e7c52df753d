#pragma once

#include <string>

namespace spelunk::evaluation {

/// Throws OutsideError with path and remedy if not all of it could be written.
void writeFile(const std::string& path, const std::string& bytes);

}  // namespace spelunk::evaluation
