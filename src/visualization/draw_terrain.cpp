#include "spelunk/visualization/draw_terrain.h"

#include <algorithm>
#include <utility>

namespace spelunk::visualization {
namespace {

using terrain::GroundClass;

constexpr Colour kBest{0.10F, 0.75F, 0.20F, 1.0F};
constexpr Colour kWorst{0.95F, 0.90F, 0.15F, 1.0F};
constexpr Colour kUntraversable{0.90F, 0.10F, 0.10F, 1.0F};
constexpr Colour kDrop{0.0F, 0.0F, 0.0F, 1.0F};
constexpr Colour kUnknown{0.50F, 0.50F, 0.50F, 1.0F};
constexpr Colour kStanding{1.0F, 1.0F, 1.0F, 1.0F};
constexpr Colour kSwinging{0.25F, 0.55F, 1.0F, 1.0F};
constexpr double kFootMark_m = 0.1;

Colour between(const Colour& from, const Colour& to, double share) {
  const auto t = static_cast<float>(std::clamp(share, 0.0, 1.0));
  return {from.r + t * (to.r - from.r), from.g + t * (to.g - from.g), from.b + t * (to.b - from.b),
          from.a + t * (to.a - from.a)};
}

}  // namespace

Colour terrainColour(const terrain::TerrainPoint& point) {
  switch (point.ground_class) {
    case GroundClass::kUnknown:
      return kUnknown;
    case GroundClass::kTraversable:
      return between(kWorst, kBest, point.value);
    case GroundClass::kTooSteep:
    case GroundClass::kStep:
    case GroundClass::kTooRough:
      return kUntraversable;
    case GroundClass::kDrop:
      return kDrop;
  }
  return kUnknown;
}

void drawTerrain(const terrain::TerrainView& view, Scene& scene) {
  Element cells;
  cells.layer = "terrain";
  cells.shape = Shape::kCubes;
  cells.size_m = view.grid().cell();
  for (const terrain::TerrainPoint& point : view.points()) {
    if (!point.position.allFinite()) continue;
    cells.points.push_back(point.position);
    cells.colours.push_back(terrainColour(point));
  }
  scene.add(std::move(cells));
}

void drawFeet(const std::vector<FootMark>& feet, Scene& scene) {
  Element marks;
  marks.layer = "feet";
  marks.shape = Shape::kSpheres;
  marks.size_m = kFootMark_m;
  for (const FootMark& foot : feet) {
    if (!foot.position.allFinite()) continue;
    marks.points.push_back(foot.position);
    marks.colours.push_back(foot.is_standing ? kStanding : kSwinging);
  }
  scene.add(std::move(marks));
}

}  // namespace spelunk::visualization
