#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/mission/basis.h"
#include "spelunk/mission/mission_status.h"
#include "spelunk/mission/plan_job.h"
#include "spelunk/mission/way_home.h"
#include "spelunk/navigation/path_monitor.h"

namespace spelunk::mission {

/// What the flight to a point needs next.
struct PointStep {
  enum class Kind {
    kNothing,
    kFly,         ///< `leg` takes over from what is flown.
    kStop,        ///< Something newly seen lies on the way: stop, then step again.
    kAsk,         ///< A new plan from here.
    kReached,     ///< It is over.
    kUnreachable  ///< It is over, `why` says why.
  };
  Kind kind = Kind::kNothing;
  Leg leg;
  std::string why;
};

/// The flight to a point that people asked for: navigation's plan, of which only what lies in known
/// free space is flown, more of it as it comes into view (Akbari 2021, section IV).
class PointFlight {
 public:
  explicit PointFlight(const Basis& basis) : basis_(basis) {}

  /// A flight to the goal of a query begins.
  void begin(const PointJob& job, double now_s);
  /// Takes up a plan, the first or a new one.
  [[nodiscard]] PointStep take(const navigation::NavigationAnswer& answer, const WayHome& way_home,
                               double now_s);
  [[nodiscard]] PointStep step(const WayHome& way_home, double now_s);
  /// The path in execution ended before its end; kNone: nobody has flown it, and so it does not
  /// count as a plan that led nowhere.
  void noteHeld(planners::PathOutcome outcome);
  void noteOccupied(const std::vector<map::VoxelIndex>& voxels);
  /// The work of a plan from here, on a map as it is now.
  [[nodiscard]] PointJob job(const std::shared_ptr<const map::FrozenMap>& map, const Rng& rng);

  /// The flight is over. Nothing happens if there is none.
  void end(GoToOutcome outcome, const std::string& why, double now_s);
  /// Forgets the flight and what became of the last one.
  void reset();

  [[nodiscard]] const GoToStatus& status() const { return status_; }
  /// The newest plan; none while there is no flight.
  [[nodiscard]] std::optional<navigation::NavigationAnswer> plan() const;

 private:
  enum class Cause { kNone, kObstacle, kDeviation };

  struct Task {
    PointJob job;  ///< Of the newest plan.
    /// The newest one; its path leads from where the robot was then to the point, unknown space
    /// included.
    navigation::NavigationAnswer plan;
    std::optional<navigation::PathMonitor> monitor;
    double taken_up_m = 0.0;       ///< The plan's length up to which it was checked and flown.
    Cause cause = Cause::kNone;    ///< Why a new plan is needed.
    std::vector<NoGoZone> unseen;  ///< Places on earlier plans that did not come into view.
    Eigen::Vector3d replanned_at = Eigen::Vector3d::Zero();
    int fruitless = 0;        ///< Replans since the robot last got somewhere.
    bool is_suspect = false;  ///< A voxel on the plan became occupied since the last look.
    double next_look_s = 0.0;
    double stopped_s = 0.0;  ///< When the last leg ended.
  };

  [[nodiscard]] PointStep lookAhead(const WayHome& way_home, double now_s);
  [[nodiscard]] PointStep takeUpMore(const WayHome& way_home, double now_s);
  [[nodiscard]] PointStep legOf(double from_m, double to_m, const WayHome& way_home, double now_s);
  [[nodiscard]] PointStep replan();
  [[nodiscard]] bool isPlanBlocked() const;
  void noteUnseen();

  Basis basis_;
  std::optional<Task> task_;
  GoToStatus status_;
};

}  // namespace spelunk::mission
