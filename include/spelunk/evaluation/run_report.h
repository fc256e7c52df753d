#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spelunk/common/local_frame.h"
#include "spelunk/evaluation/mission_run.h"

namespace spelunk::evaluation {

/// What a report says beyond the record itself.
struct ReportHeader {
  std::string planner;
  std::string world;
  std::string robot;
  std::uint64_t seed = 1;
  double time_limit_s = 0.0;
  LocalFrame frame{};  ///< The record's; the files are in its caller's.
};

/// Median, 95th percentile and maximum; zeros for no values.
struct Spread {
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};
[[nodiscard]] Spread spreadOf(std::vector<double> values);

/// Makes the folder and tries to write into it. Throws OutsideError with path and remedy.
void requireWritable(const std::string& folder);

/// summary.json, timeline.csv, clearance.csv, plans.csv, in the caller's frame. Numbers have fixed
/// decimals, so that the same run writes the same bytes (wall times stand in summary.json and
/// plans.csv only). Throws OutsideError.
void writeReport(const std::string& folder, const ReportHeader& header, const RunRecord& record);

/// Peak resident memory of this process, megabytes.
[[nodiscard]] double peakMemoryMb();

}  // namespace spelunk::evaluation
