#include "octree_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <locale>
#include <sstream>

#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr const char* kFullHeader = "# Octomap OcTree file";
constexpr const char* kLikelyHeader = "# Octomap OcTree binary file";
constexpr int kTreeDepth = 16;
constexpr std::uint64_t kMaxVoxels = std::uint64_t{1} << 30;

bool endsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// A line that readers of OctoMap files skip; none for the caller's own frame.
std::string originComment(const LocalFrame& frame) {
  if (frame.isCallers()) return "";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(12);
  text << "# origin " << frame.origin().x() << ' ' << frame.origin().y() << ' '
       << frame.origin().z() << " m: add it to every coordinate of this file";
  if (frame.yaw() != 0.0) text << ", turned by " << frame.yaw() << " rad about z before";
  text << '\n';
  return text.str();
}

std::string reason() { return std::strerror(errno); }

/// A file that replaces `path` only when everything reached the disk.
void replaceFile(const std::string& path, const std::string& content) {
  const std::string temporary = path + ".part";
  const auto fail = [&](const char* what) {
    const std::string text = "cannot " + std::string(what) + " '" + path + "': " + reason();
    std::remove(temporary.c_str());
    throw OutsideError(text + "; check the folder, its permissions and the free space");
  };
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail("create");
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t count = ::write(file, content.data() + written, content.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      ::close(file);
      errno = error;
      fail("write");
    }
    written += static_cast<std::size_t>(count);
  }
  const bool is_on_disk = ::fsync(file) == 0;
  if ((::close(file) != 0) || !is_on_disk) fail("write");
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("replace");
}

/// Reads one octree; its member functions follow the two formats' recursions.
class Reader {
 public:
  Reader(std::istream& in, const std::string& path, BlockMap& blocks)
      : in_(in), path_(path), blocks_(blocks) {}

  void readHeader(double resolution_m);
  void readTree() {
    if (size_ == 0) return;
    if (format_ == OctreeFormat::kFull)
      readFull(0, 0);
    else
      readLikely(0, 0);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw OutsideError("'" + path_ + "' " + why);
  }
  unsigned byte() {
    const int value = in_.get();
    if (value == std::char_traits<char>::eof()) fail("is cut short; save the map again");
    return static_cast<unsigned>(value);
  }
  void readFull(PackedKey corner, int depth);
  void readLikely(PackedKey corner, int depth);
  void fill(PackedKey corner, int depth, float value);

  /// Corner of a child; the key fields of children differ by their side in voxels.
  static PackedKey childCorner(PackedKey corner, int child, int child_depth) {
    const int shift = kTreeDepth - child_depth;
    return corner + (packKey(child & 1, (child >> 1) & 1, child >> 2) << shift);
  }

  std::istream& in_;
  const std::string& path_;
  BlockMap& blocks_;
  OctreeFormat format_ = OctreeFormat::kFull;
  std::uint64_t size_ = 0;
  std::uint64_t voxels_ = 0;
};

void Reader::readHeader(double resolution_m) {
  std::string line;
  std::getline(in_, line);
  if (line.rfind(kLikelyHeader, 0) == 0)
    format_ = OctreeFormat::kMaximumLikelihood;
  else if (line.rfind(kFullHeader, 0) != 0)
    fail("is not an octree: it does not begin as .bt and .ot files do");
  std::string type;
  double resolution = 0.0;
  bool has_data = false;
  while (!has_data && std::getline(in_, line)) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string name;
    words >> name;
    if (name == "id") words >> type;
    if (name == "size") words >> size_;
    if (name == "res") words >> resolution;
    has_data = name == "data";
  }
  if (!has_data) fail("is not an octree: its header has no end");
  if (type != "OcTree") fail("holds a tree of type '" + type + "'; only OcTree can be loaded");
  if (!(std::fabs(resolution - resolution_m) < 1e-9)) {
    std::ostringstream why;
    why.imbue(std::locale::classic());
    why << "has a resolution of " << resolution << " m, this map " << resolution_m
        << " m; set map.resolution_m to " << resolution << " or choose another file";
    fail(why.str());
  }
}

void Reader::readFull(PackedKey corner, int depth) {
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= byte() << (8 * i);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof(value));
  const unsigned children = byte();
  if (children == 0) {
    if (!std::isfinite(value)) fail("holds a value that is not finite");
    fill(corner, depth, value);
    return;
  }
  if (depth == kTreeDepth) fail("is damaged: it is deeper than an octree can be");
  for (int child = 0; child < 8; ++child)
    if (((children >> child) & 1) != 0) readFull(childCorner(corner, child, depth + 1), depth + 1);
}

void Reader::readLikely(PackedKey corner, int depth) {
  if (depth == kTreeDepth) fail("is damaged: it is deeper than an octree can be");
  const unsigned first = byte();
  const unsigned children = first | byte() << 8;
  const LogOdds& log_odds = blocks_.logOdds();
  for (int child = 0; child < 8; ++child) {
    const unsigned kind = (children >> (2 * child)) & 3;
    if (kind == 0) continue;
    const PackedKey at = childCorner(corner, child, depth + 1);
    if (kind == 3)
      readLikely(at, depth + 1);
    else
      fill(at, depth + 1, kind == 1 ? log_odds.clamp_min : log_odds.clamp_max);
  }
}

void Reader::fill(PackedKey corner, int depth, float value) {
  const int side = 1 << (kTreeDepth - depth);
  voxels_ += std::uint64_t{1} << (3 * (kTreeDepth - depth));
  if (voxels_ > kMaxVoxels) fail("holds more than a billion voxels, too many for this map");
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) blocks_.setValue(corner + packKey(x, y, z), value);
}

}  // namespace

OctreeFormat octreeFormatOf(const std::string& path) {
  if (endsWith(path, ".bt")) return OctreeFormat::kMaximumLikelihood;
  if (endsWith(path, ".ot")) return OctreeFormat::kFull;
  throw OutsideError("cannot tell the format of '" + path + "': its name must end in .bt or .ot");
}

void writeOctree(const octomap::OcTree& tree, OctreeFormat format, const std::string& path,
                 const LocalFrame& frame) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  const bool is_full = format == OctreeFormat::kFull;
  out << (is_full ? kFullHeader : kLikelyHeader) << "\n# written by spelunk\n"
      << originComment(frame) << "id OcTree\nsize " << tree.size() << "\nres "
      << tree.getResolution() << "\ndata\n";
  if (is_full)
    tree.writeData(out);
  else
    tree.writeBinaryData(out);
  replaceFile(path, out.str());
}

void readOctree(const std::string& path, double resolution_m, BlockMap& blocks) {
  octreeFormatOf(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw OutsideError("cannot open '" + path + "': " + reason());
  Reader reader(in, path, blocks);
  reader.readHeader(resolution_m);
  reader.readTree();
}

}  // namespace spelunk::map
