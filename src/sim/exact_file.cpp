#include "exact_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

constexpr int kDecimalsMax = 9;  // a nanometre; what follows is rounding
constexpr std::size_t kStlHeader = 84;
constexpr std::size_t kStlTriangle = 50;

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool isBinaryStl(const std::string& bytes) {
  if (bytes.size() < kStlHeader) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + kStlHeader - sizeof(triangles), sizeof(triangles));
  return bytes.size() == kStlHeader + kStlTriangle * triangles;
}

/// Bytes of a property of a PLY file; none for a type that is not known.
std::optional<std::size_t> sizeOf(const std::string& type) {
  for (const char* name : {"char", "uchar", "int8", "uint8"})
    if (type == name) return 1;
  for (const char* name : {"short", "ushort", "int16", "uint16"})
    if (type == name) return 2;
  for (const char* name : {"int", "uint", "int32", "uint32", "float", "float32"})
    if (type == name) return 4;
  if (type == "double" || type == "float64") return 8;
  return std::nullopt;
}

/// The bytes of a double in the other order: what is big-endian becomes little-endian.
std::array<char, 8> reversed(std::array<char, 8> bytes) {
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

int decimalsOf(const std::string& mantissa) {
  const std::size_t point = mantissa.find('.');
  return point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
}

}  // namespace

/// What a PLY file says before its data. The vertices must be its first element.
struct ExactFile::PlyHeader {
  std::string format;
  std::size_t vertices = 0;
  std::vector<std::pair<std::string, std::string>> properties;  ///< Of a vertex: type, name.
  std::size_t end = 0;                                          ///< Where the data begins.

  /// Which property is an axis; the number of properties if none is.
  [[nodiscard]] std::size_t find(const char* axis) const {
    std::size_t i = 0;
    while (i < properties.size() && properties[i].second != axis) ++i;
    return i;
  }
};

std::optional<ExactFile::Number> ExactFile::numberAt(std::size_t& at) const {
  while (at < bytes_.size() && (bytes_[at] == ' ' || bytes_[at] == '\t')) ++at;
  char* end = nullptr;
  const char* begin = bytes_.c_str() + at;
  if (at >= bytes_.size() || std::isspace(static_cast<unsigned char>(*begin)) != 0)
    return std::nullopt;
  const double value = std::strtod(begin, &end);
  if (end == begin) return std::nullopt;
  const Number number{at, static_cast<std::size_t>(end - begin), value};
  at += number.length;
  return number;
}

std::optional<ExactFile> ExactFile::readLines(std::string bytes, const std::string& keyword) {
  ExactFile file(std::move(bytes), Kind::kText);
  const std::string& text = file.bytes_;
  for (std::size_t line = 0; line < text.size();) {
    std::size_t at = text.find_first_not_of(" \t", line);
    const std::size_t next = std::min(text.find('\n', line), text.size() - 1) + 1;
    line = next;
    if (at == std::string::npos || text.compare(at, keyword.size(), keyword) != 0) continue;
    at += keyword.size();
    if (at >= text.size() || (text[at] != ' ' && text[at] != '\t')) continue;
    for (int k = 0; k < 3; ++k) {
      const auto number = file.numberAt(at);
      if (!number) return std::nullopt;
      file.numbers_.push_back(*number);
    }
  }
  if (file.numbers_.empty()) return std::nullopt;
  return file;
}

std::optional<ExactFile::PlyHeader> ExactFile::plyHeaderOf(const std::string& bytes) {
  PlyHeader header;
  std::istringstream lines(bytes);
  std::string element;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    std::string first;
    std::string second;
    words >> key >> first >> second;
    if (key == "format") header.format = first;
    if (key == "element") {
      if (element.empty() && first != "vertex") return std::nullopt;
      element = first;
      if (element == "vertex") header.vertices = std::strtoul(second.c_str(), nullptr, 10);
    }
    if (key == "property" && element == "vertex") header.properties.emplace_back(first, second);
    if (key != "end_header") continue;
    header.end = static_cast<std::size_t>(lines.tellg());
    return header;
  }
  return std::nullopt;
}

bool ExactFile::takePlyText(const PlyHeader& header) {
  std::size_t at = header.end;
  for (std::size_t v = 0; v < header.vertices; ++v) {
    for (const auto& [type, name] : header.properties) {
      at = bytes_.find_first_not_of(" \t\r\n", at);
      const auto number = at == std::string::npos ? std::nullopt : numberAt(at);
      if (!number) return false;
      if (name == "x" || name == "y" || name == "z") numbers_.push_back(*number);
    }
  }
  return true;
}

bool ExactFile::takePlyBinary(const PlyHeader& header) {
  std::size_t at = header.end;
  for (std::size_t v = 0; v < header.vertices; ++v) {
    for (const auto& [type, name] : header.properties) {
      const auto size = sizeOf(type);
      if (!size || at + *size > bytes_.size()) return false;
      if (name == "x" || name == "y" || name == "z") {
        std::array<char, 8> raw{};
        if (*size != raw.size()) return false;  // 32-bit numbers
        std::memcpy(raw.data(), bytes_.data() + at, raw.size());
        if (kind_ == Kind::kBigEndian) raw = reversed(raw);
        Number number{at, raw.size(), 0.0};
        std::memcpy(&number.value, raw.data(), raw.size());
        numbers_.push_back(number);
      }
      at += *size;
    }
  }
  return true;
}

std::optional<ExactFile> ExactFile::readPly(std::string bytes) {
  const auto header = plyHeaderOf(bytes);
  if (!header || header->vertices == 0) return std::nullopt;
  std::array<std::pair<std::size_t, std::size_t>, 3> axes{
      {{header->find("x"), 0}, {header->find("y"), 1}, {header->find("z"), 2}}};
  std::sort(axes.begin(), axes.end());
  if (axes[2].first == header->properties.size()) return std::nullopt;
  const bool is_text = header->format == "ascii";
  const Kind binary =
      header->format == "binary_big_endian" ? Kind::kBigEndian : Kind::kLittleEndian;
  ExactFile file(std::move(bytes), is_text ? Kind::kText : binary);
  for (std::size_t k = 0; k < 3; ++k) file.order_[k] = axes[k].second;
  if (!(is_text ? file.takePlyText(*header) : file.takePlyBinary(*header))) return std::nullopt;
  return file;
}

std::optional<ExactFile> ExactFile::read(const std::string& path) {
  const std::string extension = lowered(std::filesystem::path(path).extension().string());
  if (extension != ".obj" && extension != ".ply" && extension != ".stl") return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw OutsideError(path + ": cannot be read; check its rights");
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (extension == ".ply") return readPly(std::move(bytes));
  if (extension == ".obj") return readLines(std::move(bytes), "v");
  return isBinaryStl(bytes) ? std::nullopt : readLines(std::move(bytes), "vertex");
}

Eigen::Vector3d ExactFile::firstVertex() const {
  Eigen::Vector3d vertex;
  for (std::size_t k = 0; k < 3; ++k)
    vertex[static_cast<Eigen::Index>(order_[k])] = numbers_[k].value;
  return vertex;
}

std::string ExactFile::written(const Number& number, double value) const {
  if (kind_ == Kind::kText) {
    const std::string text = bytes_.substr(number.begin, number.length);
    const bool has_exponent = text.find_first_of("eE") != std::string::npos;
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.*f",
                  has_exponent ? kDecimalsMax : std::min(decimalsOf(text), kDecimalsMax), value);
    return buffer;
  }
  std::array<char, 8> raw{};
  std::memcpy(raw.data(), &value, raw.size());
  if (kind_ == Kind::kBigEndian) raw = reversed(raw);
  return {raw.data(), raw.size()};
}

std::string ExactFile::movedBy(const Eigen::Vector3d& by) const {
  std::string result;
  result.reserve(bytes_.size() + bytes_.size() / 8);
  std::size_t from = 0;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const Number& number = numbers_[i];
    result.append(bytes_, from, number.begin - from);
    result += written(number, number.value + by[static_cast<Eigen::Index>(order_[i % 3])]);
    from = number.begin + number.length;
  }
  return result.append(bytes_, from, std::string::npos);
}

double ExactFile::coarsestStep() const {
  double coarsest_m = 0.0;
  if (kind_ != Kind::kText) return coarsest_m;
  for (const Number& number : numbers_) {
    const std::string text = bytes_.substr(number.begin, number.length);
    const std::size_t mark = text.find_first_of("eE");
    if (mark == std::string::npos || number.value == 0.0) continue;
    const int exponent = std::atoi(text.c_str() + mark + 1);
    coarsest_m = std::max(coarsest_m, std::pow(10.0, exponent - decimalsOf(text.substr(0, mark))));
  }
  return coarsest_m;
}

}  // namespace spelunk::sim
