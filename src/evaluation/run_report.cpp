#include "spelunk/evaluation/run_report.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/mission/moved_mission.h"
#include "write_file.h"

namespace spelunk::evaluation {
namespace {

using Json = nlohmann::ordered_json;

std::string fixed(double value, int decimals = 3) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  if (std::string(text).find_first_not_of("-0.") == std::string::npos && text[0] == '-')
    return std::string(text + 1);  // no "-0.000"
  return text;
}

double rounded(double value) { return std::round(value * 1000.0) / 1000.0; }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return out + "\"";
}

std::string timelineText(const std::vector<TimelineRow>& rows) {
  std::string text = "t_s,explored_m3,distance_m,x_m,y_m,z_m,yaw_rad,remaining_s,state\n";
  for (const TimelineRow& row : rows)
    text += fixed(row.t_s) + "," + fixed(row.explored_m3) + "," + fixed(row.distance_m) + "," +
            fixed(row.pose.position.x()) + "," + fixed(row.pose.position.y()) + "," +
            fixed(row.pose.position.z()) + "," + fixed(row.pose.yaw) + "," +
            fixed(row.remaining_s) + "," + mission::toText(row.state) + "\n";
  return text;
}

std::string clearanceText(const std::vector<TimelineRow>& rows) {
  std::string text = "t_s,clearance_m\n";
  for (const TimelineRow& row : rows) text += fixed(row.t_s) + "," + fixed(row.clearance_m) + "\n";
  return text;
}

std::string planLine(const PlanRow& row) {
  const planners::PlanStats& s = row.result.stats;
  std::string line = fixed(row.t_s) + "," + (row.explore ? "explore" : "home") + "," +
                     planners::toText(row.result.status) + "," + planners::toText(row.result.kind) +
                     "," + fixed(row.length_m) + "," + fixed(s.best_gain) + "," +
                     fixed(s.gain_threshold);
  for (const int count :
       {s.samples, s.rejected_occupied, s.rejected_unknown, s.rejected_out_of_bounds,
        s.rejected_no_go, s.rejected_too_steep, s.rejected_unconnected, s.vertices, s.edges,
        s.global_vertices, s.global_edges, s.frontiers})
    line += "," + std::to_string(count);
  for (const double ms :
       {s.window_ms, s.graph_ms, s.gain_ms, s.global_ms, s.improve_ms, s.total_ms, row.wall_ms})
    line += "," + fixed(ms);
  return line + "," + quoted(row.verdict) + "," + quoted(row.result.reason) + "\n";
}

std::string plansText(const std::vector<PlanRow>& rows) {
  std::string text =
      "t_s,asked,status,kind,length_m,best_gain,gain_threshold,samples,rejected_occupied,"
      "rejected_unknown,rejected_out_of_bounds,rejected_no_go,rejected_too_steep,"
      "rejected_unconnected,vertices,edges,global_vertices,global_edges,frontiers,window_ms,"
      "graph_ms,gain_ms,global_ms,improve_ms,total_ms,wall_ms,verdict,reason\n";
  for (const PlanRow& row : rows) text += planLine(row);
  return text;
}

Json jsonOf(const Spread& spread) {
  return {{"median", rounded(spread.median)},
          {"p95", rounded(spread.p95)},
          {"max", rounded(spread.max)}};
}

Json remainingOf(const std::vector<planners::RemainingTarget>& targets) {
  Json list = Json::array();
  for (const planners::RemainingTarget& target : targets)
    list.push_back({{"x_m", rounded(target.position.x())},
                    {"y_m", rounded(target.position.y())},
                    {"z_m", rounded(target.position.z())},
                    {"gain_m3", rounded(target.gain_m3)},
                    {"why", target.why}});
  return list;
}

Json jsonOf(const Eigen::Vector3d& point) {
  return {rounded(point.x()), rounded(point.y()), rounded(point.z())};
}

Json jsonOf(const GoToRecord& record) {
  const mission::GoToStatus& status = record.status;
  Json json{{"target_m", jsonOf(record.leg.target)},
            {"method", record.leg.navigation.method},
            {"outcome", mission::toText(status.outcome)},
            {"reason", status.reason},
            {"planning_time_s", rounded(status.planning_s)},
            {"execution_time_s", rounded(record.execution_s)},
            {"replans", status.replans_obstacle + status.replans_deviation + status.replans_unseen},
            {"replans_obstacle", status.replans_obstacle},
            {"replans_deviation", status.replans_deviation},
            {"replans_unseen", status.replans_unseen},
            {"path_length_m", rounded(record.path_length_m)},
            {"final_distance_m", rounded(record.final_distance_m)}};
  if (status.nearest_reachable) json["nearest_reachable_m"] = jsonOf(*status.nearest_reachable);
  return json;
}

std::vector<double> planTimes(const RunRecord& record) {
  std::vector<double> times;
  for (const PlanRow& row : record.plans) times.push_back(row.wall_ms);
  return times;
}

/// A record in another frame.
RunRecord moved(RunRecord record, const Shift& shift) {
  using spelunk::moved;
  record.outcome = moved(record.outcome, shift);
  for (TimelineRow& row : record.timeline) row.pose = moved(row.pose, shift);
  for (PlanRow& row : record.plans) {
    row.verdict = moved(row.verdict, shift);
    row.result.reason = moved(row.result.reason, shift);
  }
  for (GoToRecord& leg : record.legs) {
    leg.leg.target = moved(leg.leg.target, shift);
    leg.status = moved(std::move(leg.status), shift);
  }
  record.remaining_targets = moved(std::move(record.remaining_targets), shift);
  if (auto& leak = record.reachable.leak) leak->place = moved(leak->place, shift);
  return record;
}

std::string summaryText(const ReportHeader& header, const RunRecord& record) {
  Json json{{"planner", header.planner},
            {"world", header.world},
            {"robot", header.robot},
            {"seed", header.seed},
            {"time_limit_s", rounded(header.time_limit_s)},
            {"outcome", record.outcome},
            {"mission_time_s", rounded(record.mission_time_s)},
            {"wall_time_s", rounded(record.wall_time_s)},
            {"explored_volume_m3", rounded(record.explored_volume_m3)},
            {"explored_outside_m3", rounded(record.explored_outside_m3)},
            {"reachable_volume_m3", rounded(record.reachable.total_m3)},
            {"mesh_leaks", record.reachable.leak.has_value()},
            {"path_length_m", rounded(record.path_length_m)},
            {"collisions", record.collisions},
            {"collision_s", rounded(record.collision_s)},
            {"min_clearance_m", rounded(record.min_clearance_m)},
            {"returned_home", record.returned_home},
            {"remaining_at_home_s", rounded(record.remaining_at_home_s)},
            {"falls", record.falls},
            {"slips", record.slips},
            {"trips", record.trips},
            {"zones_marked", record.zones_marked},
            {"way_home_unsure_s", record.promise.unsure_s},
            {"way_home_unsure_why", record.promise.unsure_why},
            {"promise_broken_ticks", record.promise.broken_ticks},
            {"promise_faults", record.promise.faults},
            {"plans", record.plans.size()},
            {"plan_time_ms", jsonOf(spreadOf(planTimes(record)))},
            {"map_update_ms", jsonOf(spreadOf(record.map_update_ms))},
            {"peak_memory_mb", rounded(peakMemoryMb())},
            {"map_origin_m", jsonOf(header.frame.origin())}};
  if (const auto& leak = record.reachable.leak) json["leak_m"] = jsonOf(leak->place);
  json["remaining_targets"] = remainingOf(record.remaining_targets);
  for (const GoToRecord& leg : record.legs) json["legs"].push_back(jsonOf(leg));
  return json.dump(2) + "\n";
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&values](double share) {
    return values[static_cast<std::size_t>(
        std::floor(share * static_cast<double>(values.size() - 1) + 0.5))];
  };
  return {at(0.5), at(0.95), values.back()};
}

void requireWritable(const std::string& folder) {
  std::error_code error;
  std::error_code ignored;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, ignored))
    throw OutsideError("output folder '" + folder + "' cannot be made (" + error.message() +
                       "): choose another with --out");
  const std::string probe = folder + "/.write_test";
  std::ofstream file(probe);
  file << "x";
  file.close();
  if (!file)
    throw OutsideError(
        "output folder '" + folder +
        "' is not writable: choose another with --out, change its rights or free some space");
  std::filesystem::remove(probe, error);
}

void writeReport(const std::string& folder, const ReportHeader& header, const RunRecord& record) {
  const RunRecord there = header.frame.isCallers() ? record : moved(record, header.frame.origin());
  writeFile(folder + "/summary.json", summaryText(header, there));
  writeFile(folder + "/timeline.csv", timelineText(there.timeline));
  writeFile(folder + "/clearance.csv", clearanceText(there.timeline));
  writeFile(folder + "/plans.csv", plansText(there.plans));
}

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace spelunk::evaluation
