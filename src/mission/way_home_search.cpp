#include "spelunk/mission/way_home_search.h"

#include "spelunk/common/message_text.h"

namespace spelunk::mission {
namespace {

std::string refusal(const navigation::NavigationQuery& query, const std::string& why) {
  return "to " + placeOf(query.goal.position) +
         withNumber(" with a box of %.2f m: ", query.box.x()) + why;
}

}  // namespace

planners::PlanResult findWayHome(const WayHomeSearch& search) {
  planners::PlanResult result;
  result.kind = planners::PathKind::kHome;
  navigation::Navigator navigator(search.params);
  for (const navigation::NavigationQuery& query : search.queries) {
    navigation::NavigationAnswer answer = navigator.plan(query);
    result.stats.samples += answer.iterations;
    result.stats.total_ms += answer.planning_ms;
    if (answer.status == navigation::NavigationStatus::kOk) {
      result.status = planners::PlanStatus::kOk;
      result.reason = "way home round what cuts the trail: " + answer.reason;
      result.path = std::move(answer.path);
      return result;
    }
    if (!result.reason.empty()) result.reason += "; ";
    result.reason += refusal(query, answer.reason);
  }
  if (search.queries.empty()) result.reason = "no free place at home, or on the trail before it";
  return result;
}

}  // namespace spelunk::mission
