#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "spelunk/mission/mission.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/ros/guarded.h"

namespace spelunk::bridge {

using GuardedPlanner = Guarded<std::unique_ptr<planners::ExplorationPlanner>>;

/// Does the work of a job. If that throws, the outcome is "no path" with the exception's text as
/// the reason, so that the mission does not wait for an answer for good.
[[nodiscard]] mission::PlanOutcome runJob(const mission::PlanJob& job, GuardedPlanner& planner);

/// The one thread that plans; see runJob().
class PlanWorker {
 public:
  /// Called in the worker's thread, the planner unlocked.
  using Finished = std::function<void(const mission::PlanOutcome&)>;

  /// `planner` must outlive the worker.
  PlanWorker(GuardedPlanner& planner, Finished finished);
  ~PlanWorker();  ///< Lets a running plan finish, drops a waiting one, joins.

  /// Hands over a job; one that still waits is replaced.
  void submit(mission::PlanJob job);

 private:
  void work();
  [[nodiscard]] std::optional<mission::PlanJob> waitForJob();

  GuardedPlanner& planner_;
  Finished finished_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<mission::PlanJob> waiting_;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace spelunk::bridge
