#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "command_line.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/pin_math.h"
#include "spelunk/evaluation/exploration_bound.h"
#include "spelunk/evaluation/run_report.h"
#include "spelunk/evaluation/tour_survey.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/world_mesh.h"
#include "write_file.h"

namespace {

using spelunk::OutsideError;

constexpr int kExitBadInput = 2;

struct Options {
  std::string world = "long_wall";
  std::string robot = "aerial";
  double time_limit_s = 900.0;
  std::string out = "best_possible_out";
  std::string start;
  double world_scale = 0.0;  ///< 0: as the world itself says.
  std::string world_up;
  std::vector<std::string> assignments;
};

void writeBound(const std::vector<double>& bound, const std::string& path) {
  std::string text = "t_s,explored_m3\n";
  for (std::size_t second = 0; second < bound.size(); ++second) {
    char line[64];
    std::snprintf(line, sizeof line, "%zu.000,%.3f\n", second, bound[second]);
    text += line;
  }
  spelunk::evaluation::writeFile(path, text);
}

void survey(const Options& options) {
  const std::string share_dir = spelunk::mission::shareDir();
  const auto config =
      spelunk::mission::loadRunConfig({share_dir, options.robot, "gbplanner", options.assignments});
  spelunk::evaluation::requireWritable(options.out);
  const auto mesh =
      spelunk::sim::openWorld(options.world, share_dir + "/worlds", spelunk::sim::defaultCacheDir(),
                              spelunk::sim::meshFrameOf(options.world_scale, options.world_up),
                              spelunk::evaluation::surroundingsOf(
                                  options.start, config.robot, config.map, options.time_limit_s));
  const spelunk::Pose start = spelunk::evaluation::startOf(options.start, mesh, config.robot.box_m);
  const spelunk::evaluation::ExplorationBound bound(mesh, start, config.robot);
  if (const auto leak = bound.leak())
    std::cerr << "best_possible: " << mesh.frame.toCaller(textOf(*leak, mesh.name)) << '\n';
  const std::vector<double> over = bound.over(options.time_limit_s);
  writeBound(over, options.out + "/bound.csv");
  const spelunk::sim::MeshScene scene(mesh);
  const auto tour = spelunk::evaluation::surveyForTour(mesh, scene, start, config.robot);
  spelunk::evaluation::writeSurvey(tour, options.out);
  std::printf("no planner explores more than %.0f m3 in %.0f s; %zu outlooks surveyed\n",
              over.back(), options.time_limit_s, tour.outlooks.size());
}

}  // namespace

int main(int argc, char** argv) {
  spelunk::pinMathLibrary(argc, argv);
  CLI::App app{
      "Bounds what any planner can explore in a world and surveys it for a tour that knows it"};
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  Options options;
  app.add_option("--world", options.world, "name from worlds/ or path of a mesh");
  app.add_option("--robot", options.robot, "name from config/robots or path of a file like those");
  app.add_option("--time-limit-s", options.time_limit_s, "the robot is home before this time")
      ->check(CLI::Range(1.0, 1e6))
      ->check(spelunk::evaluation::whyNotFinite);
  app.add_option("--out", options.out, "folder for bound.csv, survey.json and survey_seen.bin");
  app.add_option("--start", options.start, "x,y,z,yaw; wins over the world's own");
  app.add_option("--world-scale", options.world_scale,
                 "metres a unit of the mesh, 0.001 for millimetres; wins over its <name>.json");
  app.add_option("--world-up", options.world_up,
                 "axis of the mesh that points up: x, y or z; wins over its <name>.json");
  app.add_option("--set", options.assignments, "section.name=value, any parameter")->take_all();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? EXIT_SUCCESS : kExitBadInput;
  }
  try {
    survey(options);
    return EXIT_SUCCESS;
  } catch (const OutsideError& error) {
    std::cerr << "best_possible: " << error.what() << '\n';
    return kExitBadInput;
  }
}
