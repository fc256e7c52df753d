#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace spelunk::visualization {

/// Red, green, blue and opacity, each 0 .. 1.
struct Colour {
  float r = 1.0F;
  float g = 1.0F;
  float b = 1.0F;
  float a = 1.0F;
};

/// Blue over green and yellow to red for `share` from 0 to 1 (clamped); NaN counts as 0.
[[nodiscard]] Colour heatColour(double share);

enum class Shape {
  kPoints,  ///< Squares that face the viewer.
  kCubes,   ///< Axis-aligned cubes.
  kSpheres,
  kBox,        ///< One box: points[0] its centre, `extents_m` its size, `yaw` its heading.
  kLineStrip,  ///< One line through all points.
  kLineList,   ///< Separate segments: points 0-1, 2-3, ...
  kText        ///< `text` at points[0], facing the viewer.
};

/// One thing to show, world frame, metres.
struct Element {
  std::string layer;  ///< "graph/local", "path", ...: what a viewer switches on and off.
  Shape shape = Shape::kPoints;
  std::vector<Eigen::Vector3d> points;
  std::vector<Colour> colours;  ///< One for all, or one a point.
  double size_m = 0.1;          ///< Diameter, edge, line width or height of letters.
  Eigen::Vector3d extents_m = Eigen::Vector3d::Ones();
  double yaw = 0.0;
  std::string text;
};

/// What is to be seen, free of any viewer: RViz, PLY files and tests read it.
class Scene {
 public:
  /// Appends an element. Elements without points, or with a point that is not finite, are left
  /// out. Throws Precondition if there is neither one colour nor one a point, or if a line list
  /// has an odd number of points.
  void add(Element element);

  [[nodiscard]] const std::vector<Element>& elements() const { return elements_; }

  /// Elements of one layer, in the order they were added.
  [[nodiscard]] std::vector<const Element*> layer(const std::string& name) const;

 private:
  std::vector<Element> elements_;
};

/// The same scene with lines, points and letters `factor` times as large, for viewers that are
/// nearer or farther away; boxes keep their size. Throws Precondition unless `factor` is positive.
[[nodiscard]] Scene withMarksScaled(const Scene& scene, double factor);

/// Writes points and lines as a coloured PLY (ASCII; vertices and edges; texts are left out).
/// Throws OutsideError with the path if it cannot be written.
void savePly(const Scene& scene, const std::string& path);

}  // namespace spelunk::visualization
