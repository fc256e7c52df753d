#include "spelunk/ros/plan_worker.h"

#include <exception>
#include <string>
#include <utility>

#include "spelunk/common/log.h"

namespace spelunk::bridge {
namespace {

mission::PlanOutcome failed(const mission::PlanJob& job, const std::string& text) {
  mission::PlanOutcome outcome;
  outcome.number = job.number;
  outcome.plan.status = planners::PlanStatus::kNoPath;
  outcome.plan.reason = "the planner failed: " + text;
  outcome.home = outcome.plan;
  outcome.go_to.reason = outcome.plan.reason;
  outcome.home.kind = planners::PathKind::kHome;
  return outcome;
}

}  // namespace

mission::PlanOutcome runJob(const mission::PlanJob& job, GuardedPlanner& planner) {
  try {
    return planner.with([&](auto& inside) { return mission::run(job, *inside); });
  } catch (const std::exception& error) {
    log(LogLevel::kError, std::string("the planner failed: ") + error.what());
    return failed(job, error.what());
  }
}

PlanWorker::PlanWorker(GuardedPlanner& planner, Finished finished)
    : planner_(planner), finished_(std::move(finished)), thread_([this] { work(); }) {}

PlanWorker::~PlanWorker() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void PlanWorker::submit(mission::PlanJob job) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_)  // what the planner was to be told is still true
      job.reports.insert(job.reports.begin(), waiting_->reports.begin(), waiting_->reports.end());
    waiting_ = std::move(job);
  }
  wake_.notify_all();
}

std::optional<mission::PlanJob> PlanWorker::waitForJob() {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [this] { return stops_ || waiting_.has_value(); });
  if (stops_) return std::nullopt;
  return std::exchange(waiting_, std::nullopt);
}

void PlanWorker::work() {
  while (const auto job = waitForJob()) {
    const mission::PlanOutcome outcome = runJob(*job, planner_);
    try {
      finished_(outcome);
    } catch (const std::exception& error) {
      log(LogLevel::kError, std::string("a plan could not be taken over: ") + error.what());
    }
  }
}

}  // namespace spelunk::bridge
