#include "spelunk/common/file_lookup.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "spelunk/common/contract.h"

namespace spelunk {
namespace {

namespace fs = std::filesystem;

/// A path with the home folder in place of "~/", which a shell leaves as it is in
/// `world:=~/mine.stl`.
fs::path withHome(const std::string& path) {
  const char* home = std::getenv("HOME");
  if (path.rfind("~/", 0) != 0 || home == nullptr) return path;
  return fs::path(home) / path.substr(2);
}

std::vector<fs::path> candidates(const std::string& path, const std::vector<std::string>& folders) {
  const fs::path meant = withHome(path);
  if (meant.is_absolute()) return {meant};
  std::vector<fs::path> places;
  for (const std::string& folder : folders) {
    std::error_code failure;
    const fs::path place = fs::absolute(fs::path(folder) / meant, failure).lexically_normal();
    if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
  }
  return places;
}

}  // namespace

bool looksLikePath(const std::string& text) {
  return text.find('/') != std::string::npos || fs::path(text).has_extension();
}

std::string existingFile(const std::string& what, const std::string& path,
                         const std::vector<std::string>& folders) {
  std::string tried;
  for (const fs::path& place : candidates(path, folders)) {
    std::error_code failure;
    if (fs::is_regular_file(place, failure)) return place.string();
    tried += "\n  - " + place.string();
  }
  throw OutsideError(what + " '" + path +
                     "': no such file; give the path of one. Looked for:" + tried);
}

}  // namespace spelunk
