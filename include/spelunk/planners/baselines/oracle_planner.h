#pragma once

#include <string>

#include "spelunk/common/robot_model.h"
#include "spelunk/graph/path_similarity.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/baselines/oracle_params.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/remembering.h"
#include "spelunk/planners/shared/trail_home.h"

namespace spelunk::planners::baselines {

/// Reads the points of a tour: lines "x,y,z" in metres below one headline. Throws OutsideError with
/// path, line and remedy if the file is missing, has fewer than two points or anything else in it.
[[nodiscard]] graph::Polyline readTour(const std::string& path);

/// What the oracle has learnt.
struct OracleMemory {
  TrailHome trail;
  std::size_t next = 0;  ///< The first point of the tour that is still to be reached.
  ReportedPath last;
};

/// Flies a tour that somebody who knows the world has laid out, as far as the robot's own map shows
/// it to be free: what exploration is measured against, itself no exploration. Points that turn
/// out not to be free are gone round; what nothing leads to is left out.
///
/// best_gain of the stats is the length of the tour that is left, metres. planHome(): along the
/// robot's own trail and its short cuts.
class OraclePlanner final : public Remembering<OracleMemory> {
 public:
  OraclePlanner(const OracleParams& params, graph::Polyline tour, const RobotModel& robot);

  /// Layers "tour" (what is left of it) and "trail".
  [[nodiscard]] PlannerGraph graph() const override;
  /// Takes up "trail".
  void restore(const PlannerGraph& graph) override;

 private:
  struct Search;

  PlanResult doPlan(const PlanRequest& request) override;
  PlanResult doPlanHome(const PlanRequest& request) override;

  OracleParams params_;
  graph::Polyline tour_;
  RobotModel robot_;
  navigation::Navigator navigator_;
  map::ConfigurationSpace boxes_;
};

}  // namespace spelunk::planners::baselines
