#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace spelunk::sim {

/// A mesh file whose vertices are written as decimal text or as 64-bit numbers, read in double
/// precision: OBJ, PLY as text, PLY with binary doubles, STL as text. Readers of meshes hold
/// vertices as 32-bit numbers, which lie half a metre apart at UTM northings; so they are given the
/// file with every vertex moved near to 0 before.
class ExactFile {
 public:
  /// Nothing if the format has 32-bit numbers, or is not one of those above, or is damaged: let the
  /// reader of meshes say what it thinks of it. Throws OutsideError if the file cannot be read.
  [[nodiscard]] static std::optional<ExactFile> read(const std::string& path);

  [[nodiscard]] Eigen::Vector3d firstVertex() const;

  /// The same file with `by` added to every vertex; decimal text keeps its number of decimals.
  [[nodiscard]] std::string movedBy(const Eigen::Vector3d& by) const;

  /// The coarsest step of any coordinate that is written with an exponent, metres: 10000 for
  /// "5.42e+06", whose digits end there. 0 if there is none.
  [[nodiscard]] double coarsestStep() const;

 private:
  /// A coordinate and the bytes it stands in.
  struct Number {
    std::size_t begin = 0;
    std::size_t length = 0;
    double value = 0.0;
  };
  enum class Kind { kText, kLittleEndian, kBigEndian };

  struct PlyHeader;

  ExactFile(std::string bytes, Kind kind) : bytes_(std::move(bytes)), kind_(kind) {}
  static std::optional<ExactFile> readLines(std::string bytes, const std::string& keyword);
  static std::optional<ExactFile> readPly(std::string bytes);
  static std::optional<PlyHeader> plyHeaderOf(const std::string& bytes);
  bool takePlyText(const PlyHeader& header);
  bool takePlyBinary(const PlyHeader& header);

  /// Takes the number that begins at `at` or after blanks; moves `at` behind it.
  std::optional<Number> numberAt(std::size_t& at) const;
  [[nodiscard]] std::string written(const Number& number, double value) const;

  std::string bytes_;
  Kind kind_;
  std::vector<Number> numbers_;                ///< In the order of the file, three a vertex.
  std::array<std::size_t, 3> order_{0, 1, 2};  ///< Axis of the first, second, third of a vertex.
};

}  // namespace spelunk::sim
