#include "spelunk/sim/world_plan.h"

#include <filesystem>
#include <map>

#include "spelunk/common/contract.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

constexpr const char* kKinds =
    "drifts, rooms, cave, ramps, rough, room, maze, shafts, walls or levels";

struct CommonParams {
  std::string kind;
  int seed = 1;
  double cell_m = 0.5;
  double roughness_m = 0.3;
  double grain_m = 3.5;
  double blend_m = 0.8;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("kind", kind, Bounds{}, kKinds);
    field("seed", seed, Bounds{0, 2e9}, "another seed, another world of the same kind");
    field("cell_m", cell_m, Bounds{0.1, 2.0}, "grid of the surface");
    field("roughness_m", roughness_m, Bounds{0.0, 2.0}, "depth of the roughness of walls");
    field("grain_m", grain_m, Bounds{0.5, 30.0}, "size of the bulges of that roughness");
    field("blend_m", blend_m, Bounds{0.05, 5.0}, "rounding where spaces meet");
  }
};

struct StartParams {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 1.0;
  double yaw_rad = 0.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("x_m", x_m, Bounds{-2000.0, 2000.0}, "start of a mission");
    field("y_m", y_m, Bounds{-2000.0, 2000.0}, "start of a mission");
    field("z_m", z_m, Bounds{-200.0, 200.0}, "start of a mission");
    field("yaw_rad", yaw_rad, Bounds{-3.1416, 3.1416}, "start of a mission");
  }
};

/// The names a description of one kind may hold, for messages.
template <class Params>
std::string knownNames(const Params& kind_params) {
  std::string names;
  const auto append = [&](const std::vector<ParamDescription>& lines, std::size_t prefix) {
    for (const ParamDescription& line : lines)
      names += (names.empty() ? "" : ", ") + line.name.substr(prefix);
  };
  append(describe("world", CommonParams{}), 6);
  append(describe("world", kind_params), 6);
  append(describe("start", StartParams{}), 0);
  return names;
}

/// Adds a problem for each "..._min_<unit>" that exceeds its "..._max_<unit>".
template <class Params>
void addOrderProblems(Params params, ParamTree& tree) {
  std::map<std::string, double> values;
  params.visit([&](const char* name, auto value, Bounds, const char*) {
    values[name] = static_cast<double>(value);
  });
  for (const auto& [low, value] : values) {
    const std::size_t at = low.find("_min_");
    if (at == std::string::npos) continue;
    const std::string high = low.substr(0, at) + "_max_" + low.substr(at + 5);
    if (value > values.at(high)) tree.addProblem(low + " must not exceed " + high);
  }
}

/// Reads what is left of a description, checks it as a whole and lays the world out.
template <class Params>
void finish(ParamTree& tree, const std::string& path, WorldPlan& plan) {
  Params params;
  tree.read("world", params);
  addOrderProblems(params, tree);
  try {
    tree.requireClean();
  } catch (const OutsideError& error) {
    throw OutsideError("world description '" + path + "': " + error.what() +
                       "\n  known names: " + knownNames(params));
  }
  layOut(params, plan);
}

}  // namespace

WorldPlan planWorld(const std::string& description_path) {
  ParamTree tree;
  tree.addYamlFile(description_path);
  CommonParams common;
  StartParams start;
  tree.read("world", common);
  tree.read("start", start);

  WorldPlan plan;
  plan.name = std::filesystem::path(description_path).stem().string();
  plan.cell_m = common.cell_m;
  plan.roughness_m = common.roughness_m;
  plan.grain_m = common.grain_m;
  plan.blend_m = common.blend_m;
  plan.seed = static_cast<std::uint64_t>(common.seed);
  plan.start = {{start.x_m, start.y_m, start.z_m}, start.yaw_rad};
  if (common.kind == "drifts") {
    finish<DriftsParams>(tree, description_path, plan);
  } else if (common.kind == "rooms") {
    finish<RoomsParams>(tree, description_path, plan);
  } else if (common.kind == "cave") {
    finish<CaveParams>(tree, description_path, plan);
  } else if (common.kind == "ramps") {
    finish<RampsParams>(tree, description_path, plan);
  } else if (common.kind == "rough") {
    finish<RoughParams>(tree, description_path, plan);
  } else if (common.kind == "room") {
    finish<RoomParams>(tree, description_path, plan);
  } else if (common.kind == "maze") {
    finish<MazeParams>(tree, description_path, plan);
  } else if (common.kind == "shafts") {
    finish<ShaftsParams>(tree, description_path, plan);
  } else if (common.kind == "walls") {
    finish<WallsParams>(tree, description_path, plan);
  } else if (common.kind == "levels") {
    finish<LevelsParams>(tree, description_path, plan);
  } else {
    throw OutsideError("world description '" + description_path + "': kind = '" + common.kind +
                       "' is not known; write kind: " + kKinds);
  }
  return plan;
}

double passageLength(const WorldPlan& plan) {
  double length = 0.0;
  for (const Passage& passage : plan.passages)
    for (std::size_t i = 1; i < passage.stations.size(); ++i)
      length += (passage.stations[i].floor - passage.stations[i - 1].floor).norm();
  return length;
}

}  // namespace spelunk::sim
