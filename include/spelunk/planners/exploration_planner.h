#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/moved.h"
#include "spelunk/common/path.h"
#include "spelunk/common/rng.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::planners {

/// Every expected outcome of a plan.
enum class PlanStatus {
  kOk,              ///< A path was found.
  kNothingToGain,   ///< Explored: nothing reachable above the gain threshold is left.
  kBudgetSaysHome,  ///< Something is left, but no target fits the remaining endurance.
  kStartBlocked,    ///< The robot's box at the start is not in known free space.
  kOutOfBounds,     ///< The start lies outside the bounds or inside a no-go zone.
  kNoPath           ///< A target exists but no collision-free path to it was found.
};

enum class PathKind { kLocal, kReposition, kHome };

[[nodiscard]] const char* toText(PlanStatus status);
[[nodiscard]] const char* toText(PathKind kind);

/// What became of a path; told to the planner by report().
enum class PathOutcome {
  kNone,            ///< There was no path, or nobody has flown it.
  kReached,         ///< Flown to its end.
  kReplaced,        ///< It is being flown; a newer one will take over before its end, as intended.
  kBlocked,         ///< A new obstacle (or zone) cut it.
  kDeviated,        ///< The robot left it.
  kRejectedUnsafe,  ///< mission's own check refused it.
  kRejectedBudget   ///< No way home from its end would have fitted the endurance.
};

/// What a planner would remember if a plan of its were taken; only that planner looks into it.
struct PlanMemory {
  virtual ~PlanMemory() = default;
};

struct StampedPose {
  double time_s = 0.0;
  Pose pose;
};

/// Limits the caller sets on one plan. Iterations make runs repeatable; seconds are for flight.
struct PlanBudget {
  int iterations = 10000;  ///< Samples tried at most.
  double seconds = 1e9;    ///< Wall time; checked now and then.
};

/// All a planner may know for one plan. Nothing in it is kept beyond the call, `map` apart.
struct PlanRequest {
  std::shared_ptr<const map::FrozenMap> map;
  double time_s = 0.0;  ///< Mission time.
  Pose pose;            ///< Where the path is to start (may lie ahead of the robot).
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Expected there, world frame.
  Pose home;
  double remaining_s = 1e9;  ///< Endurance left at `pose`, the reserve already taken off.
  AxisAlignedBox bounds;     ///< Global bounds of exploration.
  std::vector<NoGoZone> zones;
  std::uint64_t zones_revision = 0;  ///< Another number whenever the zones have changed.
  std::vector<StampedPose> trail;    ///< Where the robot was, oldest first, about 1 m or 1 s apart.
  /// Of a plan that is to count as taken: for the way home from the end of its path. Else none.
  std::shared_ptr<const PlanMemory> after;
  PlanBudget budget;
  Rng rng{0};  ///< This plan's own stream.
};

/// Counters and timings that explain a result.
struct PlanStats {
  int samples = 0;
  int rejected_occupied = 0;
  int rejected_unknown = 0;
  int rejected_out_of_bounds = 0;
  int rejected_no_go = 0;
  int rejected_too_steep = 0;
  int rejected_unconnected = 0;
  int vertices = 0;
  int edges = 0;
  int global_vertices = 0;
  int global_edges = 0;
  int frontiers = 0;
  double best_gain = 0.0;  ///< In the planner's own unit (see its header).
  double gain_threshold = 0.0;
  double window_ms = 0.0;
  double graph_ms = 0.0;
  double gain_ms = 0.0;
  double global_ms = 0.0;
  double improve_ms = 0.0;
  double total_ms = 0.0;
};

/// A place that was not explored, and why not.
struct RemainingTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double gain_m3 = 0.0;
  std::string why;
};
/// The same in another frame; places named in `why` included.
[[nodiscard]] RemainingTarget moved(RemainingTarget target, const Shift& shift);

struct PlanResult {
  PlanStatus status = PlanStatus::kNoPath;
  PathKind kind = PathKind::kLocal;
  Path path;           ///< Starts at the requested pose; empty unless status is kOk.
  std::string reason;  ///< One sentence for people: why this path, or why none.
  PlanStats stats;
  std::vector<RemainingTarget> remaining;
  std::shared_ptr<const PlanMemory> memory;  ///< To be handed back by report() if it is taken.
};

/// What became of a plan: it is taken (its path is flown, or there is none), or its path is
/// refused, or the path that was reported last has ended.
struct PathReport {
  std::shared_ptr<const PlanMemory> plan;  ///< None for the path that was reported last.
  PathOutcome outcome = PathOutcome::kNone;
  std::string reason;
};

/// A planner's graph for display, saving and tests.
struct GraphVertex {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double gain_m3 = 0.0;
  bool is_frontier = false;
};
struct GraphLayer {
  std::string name;  ///< "local", "global", ...
  std::vector<GraphVertex> vertices;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
};
struct PlannerGraph {
  std::vector<GraphLayer> layers;
};
[[nodiscard]] PlannerGraph moved(PlannerGraph graph, const Shift& shift);

/// The interface of every exploration planner. Proposing is apart from taking: plan() and
/// planHome() change nothing that a later plan depends on, so anybody may look at a plan at any
/// time; what a planner learns it learns by report(). A new planner has learnt nothing. Not
/// thread-safe: one caller at a time.
class ExplorationPlanner {
 public:
  virtual ~ExplorationPlanner() = default;

  /// Proposes the next path on a frozen map. Throws Precondition if the map is missing, the pose
  /// not finite or the budget empty.
  [[nodiscard]] PlanResult plan(const PlanRequest& request);

  /// The planner's best way home from `request.pose`; kind is kHome. Same contract as plan().
  [[nodiscard]] PlanResult planHome(const PlanRequest& request);

  /// Tells what became of a plan of this planner. Throws Precondition for another one's.
  void report(const PathReport& report) { doReport(report); }

  [[nodiscard]] virtual PlannerGraph graph() const = 0;

  /// Takes up a graph saved earlier by graph(); layers it does not know are ignored.
  virtual void restore(const PlannerGraph& graph) = 0;

 private:
  virtual PlanResult doPlan(const PlanRequest& request) = 0;
  virtual PlanResult doPlanHome(const PlanRequest& request) = 0;
  virtual void doReport(const PathReport& report) = 0;
};

}  // namespace spelunk::planners
