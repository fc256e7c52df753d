#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/map/openings.h"
#include "spelunk/mission/basis.h"
#include "spelunk/mission/plan_job.h"
#include "spelunk/mission/transitions.h"
#include "spelunk/mission/way_home.h"

namespace spelunk::mission {

/// A plan that was handed out.
struct RunningJob {
  enum class Kind {
    kExplore,     ///< The planner's next path.
    kSecondLook,  ///< The same on the way home: is something affordable again?
    kPlannersWayHome,
    kNavigationsWayHome,
    kPoint
  };
  std::uint64_t number = 0;
  Kind kind = Kind::kExplore;
  bool from_standstill = false;
  double asked_s = 0.0;
  double takes_over_s = 0.0;  ///< When the robot is where the plan begins.
  Pose pose;                  ///< There.

  /// Whether an answer of now comes before the robot is beyond where the plan begins.
  [[nodiscard]] bool isInTime(double now_s) const {
    constexpr double kRounding_s = 1e-6;
    return now_s <= takes_over_s + kRounding_s;
  }
};

/// What is asked of whom, and when: one plan at a time, begun so early that its answer comes before
/// the robot is where it takes over. It collects what became of the planner's paths and has it told
/// to the planner with the next job.
class PlanDesk {
 public:
  PlanDesk(const Basis& basis, const Rng& rng) : basis_(basis), rng_(rng) {}

  // --- When to ask.
  void askAt(double time_s) { next_ask_s_ = time_s; }
  void askBy(double time_s);  ///< Not later than that.
  /// A new exploration begins.
  void beginExploring(double now_s);
  enum class SecondLooks { kNone, kAllowed };
  /// A way home is wanted at once.
  void beginHome(SecondLooks looks, double now_s);
  void wantWayHome() { wants_way_home_ = true; }
  /// Forgets the plan that is being computed.
  void drop();

  // --- Asking.
  [[nodiscard]] bool isBusy() const { return running_.has_value() || pending_.has_value(); }
  [[nodiscard]] bool wantsPlan(Task task, const WayHome& way_home, double now_s) const;
  /// Prepares the job that the task needs now; there is none if it would begin too near to an
  /// obstacle.
  void ask(Task task, WayHome& way_home, double now_s);
  /// Prepares a job of navigation's for a flight to a point; `fill` is given map and random stream.
  template <class Fill>
  void askForPoint(WayHome& way_home, double now_s, Fill&& fill) {
    const RunningJob job = begin(RunningJob::Kind::kPoint, now_s);
    const auto map = freeze(way_home);
    submit(job, fill(map, rng_.fork("go_to/" + std::to_string(job.number))));
  }
  /// A request from a pose on, with all the mission knows; the caller sets `rng`.
  [[nodiscard]] planners::PlanRequest requestAt(const Pose& pose, double time_s,
                                                const WayHome& way_home);
  [[nodiscard]] std::optional<PlanJob> takeJob();

  // --- Answers.
  /// The job that an outcome belongs to; none if it is not wanted any more.
  [[nodiscard]] std::optional<RunningJob> finish(const PlanOutcome& outcome, double now_s);
  /// The planner's path is flown from now on.
  void noteAccepted(const planners::PlanResult& plan, double now_s);
  void noteFlown() { asks_navigation_ = false; }
  void noteRefused(const planners::PlanResult& plan, planners::PathOutcome outcome,
                   const std::string& why);
  /// The planner has no path: what it found out about that counts.
  void noteNone(const planners::PlanResult& plan);
  /// What became of the planner's path that was flown.
  void noteOutcome(planners::PathOutcome outcome, const std::string& reason);
  /// What was to be told to the planner is about a past that was replaced by a saved one.
  void forgetReports() { reports_.clear(); }
  void noteSecondLook(const planners::PlanResult& plan, double now_s);
  /// A path was refused while another one is flown.
  void retryInFlight(double now_s);
  /// No plan was found; true if that was so for too long.
  [[nodiscard]] bool noteFailure(double now_s);
  /// A path was refused because it leaves no way home; true if that was so for too long.
  [[nodiscard]] bool noteUnaffordable();
  void closeWayHomeRequest() { wants_way_home_ = false; }
  /// Nobody knew another way home.
  void noteNoWayHome(const RunningJob& job, double now_s);

  /// Openings that the robot leaves behind on its way home.
  void noteOpenings(const std::vector<map::Opening>& openings);

  // --- What there is to see.
  struct Counts {
    int plans = 0;
    int refused_paths = 0;
    double known_volume_m3 = 0.0;
    std::string last_plan_status;
    planners::PlanStats last_stats;
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const std::vector<planners::RemainingTarget>& remaining() const {
    return remaining_;
  }

 private:
  void gatherRemaining();
  [[nodiscard]] bool wantsPlanInFlight(double now_s) const;
  [[nodiscard]] bool wantsSecondLook(const WayHome& way_home, double now_s) const;
  [[nodiscard]] RunningJob begin(RunningJob::Kind kind, double now_s);
  [[nodiscard]] RunningJob::Kind kindFor(Task task) const;
  std::shared_ptr<const map::FrozenMap> freeze(WayHome& way_home);
  void submit(const RunningJob& job,
              std::variant<ExplorationJob, WayHomeJob, WayHomeSearch, PointJob> work);

  Basis basis_;
  Rng rng_;
  std::optional<PlanJob> pending_;
  std::optional<RunningJob> running_;
  std::uint64_t next_job_ = 1;
  double next_ask_s_ = 0.0;
  double last_accept_s_ = 0.0;
  double latency_s_ = 0.0;  ///< Of the newest plan.
  int failures_ = 0;        ///< In a row.
  bool wants_way_home_ = false;
  bool may_look_again_ = false;  ///< On this way home.
  double next_look_s_ = 0.0;
  bool asks_navigation_ = false;               ///< The next way home is the mission's own search.
  std::vector<planners::PathReport> reports_;  ///< Not told to the planner yet.
  bool flies_reported_path_ = false;  ///< Whether the path that was reported last is the one flown.
  Counts counts_;
  std::vector<planners::RemainingTarget> planner_left_;  ///< What the newest plan named.
  std::vector<planners::RemainingTarget> openings_;
  std::vector<planners::RemainingTarget> remaining_;  ///< Both.
};

}  // namespace spelunk::mission
