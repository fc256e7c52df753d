#pragma once

#include <memory>
#include <string>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners {

/// What every planner remembers: what became of the path that was reported last.
struct ReportedPath {
  PathOutcome outcome = PathOutcome::kNone;
  std::string reason;
};

/// A planner whose memory is one value. A plan works on a copy of it, which becomes the planner's
/// memory only if the plan is reported; so a plan that nobody takes leaves no trace.
template <class Memory>
class Remembering : public ExplorationPlanner {
 protected:
  explicit Remembering(Memory memory) : memory_(std::move(memory)) {}

  /// A copy of what a plan may know.
  [[nodiscard]] Memory recall(const PlanRequest& request) const {
    return request.after ? kept(*request.after) : memory_;
  }
  /// The result of a plan with what is to be remembered of it.
  [[nodiscard]] static PlanResult remembering(PlanResult result, Memory memory) {
    result.memory = std::make_shared<const Kept>(std::move(memory));
    return result;
  }
  [[nodiscard]] const Memory& memory() const { return memory_; }
  [[nodiscard]] Memory& memory() { return memory_; }

 private:
  struct Kept : PlanMemory {
    explicit Kept(Memory memory) : value(std::move(memory)) {}
    Memory value;
  };

  [[nodiscard]] static const Memory& kept(const PlanMemory& memory) {
    const auto* own = dynamic_cast<const Kept*>(&memory);
    require(own != nullptr, "report: the plan is another planner's");
    return own->value;
  }

  void doReport(const PathReport& report) final {
    if (report.plan) memory_ = kept(*report.plan);
    memory_.last = {report.outcome, report.reason};
  }

  Memory memory_;
};

}  // namespace spelunk::planners
