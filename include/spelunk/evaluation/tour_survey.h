#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "spelunk/common/pose.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/evaluation/target_voxels.h"
#include "spelunk/sim/mesh_scene.h"

namespace spelunk::evaluation {

/// How finely a world is surveyed for a tour that knows it.
struct SurveyParams {
  double step_m = 0.3;      ///< Between the positions ways lead through, in plan.
  double rise_m = 0.4;      ///< The same in height.
  double margin_m = 0.1;    ///< Kept between the robot's box and the mesh: maps are coarse.
  double outlook_m = 3.5;   ///< Outlooks that see each other are at least this far apart.
  double way_max_m = 12.0;  ///< Longest way between two outlooks that is noted.
  double target_m = 0.8;    ///< Edge of a voxel that is seen or not.
};

/// Outlooks in a known world, short ways between them, and what a standing, level robot sees from
/// each; one whose sensors do not see all round turns about once. Outlook 0 is the start.
struct TourSurvey {
  struct Way {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    double length_m = 0.0;
    std::vector<Eigen::Vector3d> points;  ///< Both ends included.
  };
  double speed_mps = 0.0;  ///< Of the robot.
  std::vector<Eigen::Vector3d> outlooks;
  std::vector<Way> ways;
  std::vector<std::vector<std::uint8_t>>
      seen;                        ///< One bit a target voxel an outlook, lowest first.
  std::vector<double> volumes_m3;  ///< Of the target voxels.
};

/// Surveys what the robot's box (axis-aligned) and the margin can reach from the start without
/// meeting the mesh. Throws OutsideError as reachableVolume() does.
[[nodiscard]] TourSurvey surveyForTour(const sim::WorldMesh& mesh, const sim::MeshScene& scene,
                                       const Pose& start, const RobotModel& robot,
                                       const SurveyParams& params = {});

/// Writes survey.json (speed_mps, outlooks, ways, volumes_m3) and survey_seen.bin (a row of bytes
/// an outlook) into a folder. Places are in the frame of the mesh, as those of oracle.tour are.
/// Throws OutsideError.
void writeSurvey(const TourSurvey& survey, const std::string& folder);

}  // namespace spelunk::evaluation
