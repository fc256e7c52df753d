#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/informed/approaches.h"
#include "spelunk/planners/informed/graph_growth.h"
#include "spelunk/planners/informed/informed_params.h"
#include "spelunk/planners/informed/scouting.h"
#include "spelunk/planners/shared/frontier_view.h"
#include "spelunk/planners/shared/remembering.h"
#include "spelunk/planners/shared/tried_targets.h"
#include "spelunk/planners/shared/visits.h"

namespace spelunk::planners::informed {

/// What Informed Exploration has learnt.
struct InformedMemory {
  /// The newest path proposed by plan().
  struct Proposal {
    Path path;
    PathKind kind = PathKind::kLocal;
    double gain_m3 = 0.0;
    Eigen::Vector3d voxel = Eigen::Vector3d::Zero();  ///< The frontier voxel it is for.
  };

  explicit InformedMemory(const InformedParams& params)
      : growth(params), scouting(params), tried(params.tried_radius_m) {}

  GraphGrowth growth;
  Scouting scouting;
  Approaches approaches;
  TriedTargets tried;
  Visits visits;
  std::optional<Proposal> proposal;
  ReportedPath last;
  std::shared_ptr<const map::FrozenMap> checked_map;
  std::uint64_t checked_zones = 0;  ///< Their revision.
  std::size_t reopened_at_voxels = 0;
};

/// Informed Exploration for robots that fly: Akbari and Bernardini, Informed Autonomous Exploration
/// of Subterranean Environments, IEEE Robotics and Automation Letters, 2021.
///
/// plan(): one turn of Alg. 1, the exploration manager. best_gain and gain_threshold of the stats
/// are cubic metres of unknown space seen from the sample; global_vertices and global_edges are the
/// reachability graph's |V| and |E|; vertices counts the samples and the states of the trees that
/// were grown to them.
/// planHome(): GoHome, along the reachability graph, else by the motion planner.
class InformedPlanner final : public Remembering<InformedMemory> {
 public:
  /// `resolution_m`: of the maps it will be asked on. Throws Precondition for a robot with legs.
  InformedPlanner(const InformedParams& params, const RobotModel& robot, double resolution_m);

  /// Layers "search" (trees of the newest search), "samples" (frontier samples, by utility) and
  /// "reachability".
  [[nodiscard]] PlannerGraph graph() const override;
  void restore(const PlannerGraph& graph) override;

 private:
  using Proposal = InformedMemory::Proposal;
  struct Search;

  PlanResult doPlan(const PlanRequest& request) override;
  PlanResult doPlanHome(const PlanRequest& request) override;

  InformedParams params_;
  RobotModel robot_;
  FrontierView view_;
  navigation::Navigator navigator_;
  map::ConfigurationSpace boxes_;
  // Of the newest plan, taken or not; to be looked at.
  GraphLayer search_layer_;
  GraphLayer samples_layer_;
};

}  // namespace spelunk::planners::informed
