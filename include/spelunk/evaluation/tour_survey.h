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
  double spacing_m = 1.25;  ///< Between places in plan.
  double layer_m = 1.0;     ///< Between places in height.
  double outlook_m = 2.0;   ///< Outlooks are at least this far apart.
  double margin_m = 0.2;    ///< Kept between the robot's box and the mesh.
  double target_m = 0.8;    ///< Edge of a voxel that is seen or not.
};

/// Places of a known world, the straight ways between them, and what a standing, level robot sees
/// from some of them. Place 0 is the start.
struct TourSurvey {
  struct Way {
    std::uint32_t from;
    std::uint32_t to;
    double length_m;
  };
  std::vector<Eigen::Vector3d> places;
  std::vector<Way> ways;
  std::vector<std::uint32_t> outlooks;  ///< Places that were looked from; 0 is the first.
  std::vector<std::vector<std::uint8_t>>
      seen;                        ///< One bit a target voxel an outlook, lowest first.
  std::vector<double> volumes_m3;  ///< Of the target voxels.
};

/// Surveys what can be reached from the start by straight ways between places, the box of the
/// robot (axis-aligned) and the margin never meeting the mesh. Throws OutsideError as
/// reachableVolume() does.
[[nodiscard]] TourSurvey surveyForTour(const sim::WorldMesh& mesh, const sim::MeshScene& scene,
                                       const Pose& start, const RobotModel& robot,
                                       const SurveyParams& params = {});

/// Writes survey.json (places, ways, outlooks, volumes_m3) and survey_seen.bin (a row of bytes an
/// outlook) into a folder. Throws OutsideError.
void writeSurvey(const TourSurvey& survey, const std::string& folder);

}  // namespace spelunk::evaluation
