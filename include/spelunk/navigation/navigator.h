#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/params.h"
#include "spelunk/common/path.h"
#include "spelunk/common/rng.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::navigation {

/// Parameters of point-to-point navigation (section "navigation").
struct NavigationParams {
  std::string method = "adaptive";
  double safe_distance_m = 0.2;
  double extension_m = 1.0;
  int iterations = 20000;
  double planning_time_s = 10.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("method", method, Bounds{},
          "adaptive (A-NAV), rrt_star, plain (R-NAV) or plain_short (R-NAV with shortened paths)",
          Audience::kUser);
    field("safe_distance_m", safe_distance_m, Bounds{0.0, 5.0},
          "kept between the robot's box and obstacles where that is possible", Audience::kUser);
    field("extension_m", extension_m, Bounds{0.2, 20.0},
          "longest step of a tree; rrt_star takes four times this");
    field("iterations", iterations, Bounds{1, 10000000},
          "tree extensions tried at most; rrt_star uses them all unless its way is straight");
    field("planning_time_s", planning_time_s, Bounds{0.01, 1000.0},
          "longest wall time of one query in flight; lockstep counts iterations only");
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

enum class NavigationStatus {
  kOk,
  kStartBlocked,  ///< The box at the start, and everywhere within 0.6 m of it, is not known free.
  kGoalBlocked,   ///< The box at the goal touches an obstacle.
  kGoalUnknown,   ///< The goal is not in known free space, which the query asked for.
  kOutOfBounds,   ///< The goal lies outside the bounds.
  kNoGo,          ///< The goal, or the start, lies in a no-go zone.
  kNoPath         ///< Unreachable as far as the limits of the search could tell.
};
[[nodiscard]] const char* toText(NavigationStatus status);

/// Where trees may grow.
enum class SearchRegion {
  kByGoal,  ///< As the method has it; see Navigator.
  kKnown    ///< Known free space only, whatever the method; a goal in unknown space is refused.
};

/// What an answer holds beside the path.
enum class TreeDetail { kLeaveOut, kKeep };

struct NavigationQuery {
  std::shared_ptr<const map::FrozenMap> map;
  Pose start;
  Pose goal;
  Eigen::Vector3d box = Eigen::Vector3d::Ones();  ///< Robot, full extents, metres.
  AxisAlignedBox bounds;
  std::vector<NoGoZone> zones;
  SearchRegion region = SearchRegion::kByGoal;
  TreeDetail trees = TreeDetail::kLeaveOut;
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< Wall time; for flight only.
  Rng rng{0};
};

/// Vertices of the trees of a search (RRT-Connect has two) and the edges between them.
struct NavigationTrees {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
};

struct NavigationAnswer {
  NavigationStatus status = NavigationStatus::kNoPath;
  std::string reason;  ///< One sentence.
  Path path;           ///< From start to goal; empty unless status is kOk.
  /// The path up to here (arc length) is in known free space for the whole box; its length if the
  /// whole path is. Only that part may be flown.
  double known_length_m = 0.0;
  double safe_distance_m = 0.0;  ///< What the path keeps, away from its two ends.
  int iterations = 0;            ///< Of all searches of this query.
  double planning_ms = 0.0;      ///< Wall time.
  /// The place in known free space nearest to the goal that the search got to; only with kNoPath.
  std::optional<Eigen::Vector3d> nearest_reachable;
  NavigationTrees trees;  ///< Of the last search, if asked for; empty where none was needed.
};

/// Point-to-point navigation on a map that is partly unknown. Three methods:
///
/// "adaptive" is A-NAV (Akbari and Bernardini, "Informed autonomous exploration of subterranean
/// environments", IEEE Robotics and Automation Letters, 2021, section IV): RRT-Connect (Kuffner
/// and LaValle, ICRA 2000, as OMPL has it) whose trees grow in known free space only if the goal is
/// known, from samples drawn inside that space; through free and unknown space if it is not. States
/// and steps that come nearer to an obstacle than the safe distance are not added, within 1 m of
/// start and goal apart.
/// Differs from paper: in the second case half of the draws still come from known space, without
/// which a tree hardly finds out of a narrow place; where no path keeps the safe distance, the
/// robot's own box decides (it holds a margin already); where known space holds no path to a known
/// goal, unknown space may be crossed after all, because a frontier seen through a gap would else
/// end a mission.
///
/// "plain" is R-NAV, what the paper compares with: RRT-Connect through free and unknown space alike
/// with samples from the whole box around what is known, start and goal, without safe distance and
/// as it comes: no straight line is tried first and nothing is shortened. "plain_short" is the same
/// with both, which the paper does not have: a stronger thing to compare with.
///
/// "rrt_star" searches where "adaptive" does, by RRT* (Karaman and Frazzoli, IJRR 2011): its one
/// tree is rewired until the iterations are used up or the way is hardly longer than a straight
/// line, so that ways come near to the shortest, at many times the cost.
///
/// Paths are shortened by OMPL's path simplification under the same rules as the search. The same
/// query gives the same answer, unless its time limit cuts it short. Keeps what it
/// inflated between queries with the same box; of another map only what changed is done again. Not
/// thread-safe.
class Navigator {
 public:
  /// Throws Precondition if the parameters have problems().
  explicit Navigator(const NavigationParams& params);
  ~Navigator();
  Navigator(Navigator&&) noexcept;
  Navigator& operator=(Navigator&&) noexcept;

  /// Throws Precondition if the map is missing, or a pose or the box is not finite. A start that
  /// touches something is left by a step of at most 0.6 m to free space, if there is some.
  [[nodiscard]] NavigationAnswer plan(const NavigationQuery& query);

  /// Whether a box at a place keeps the safe distance from all that is known to be occupied.
  [[nodiscard]] bool keepsSafeDistance(const std::shared_ptr<const map::FrozenMap>& map,
                                       const Eigen::Vector3d& box, const Eigen::Vector3d& place);

  [[nodiscard]] const NavigationParams& params() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::navigation
