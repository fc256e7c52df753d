#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>

#include "command_line.h"
#include "folder_lock.h"
#include "run_program.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/common/pin_math.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/evaluation/plan_view.h"
#include "spelunk/evaluation/run_report.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/planners/factory.h"
#include "spelunk/sim/simulator.h"
#include "spelunk/sim/world_mesh.h"

namespace {

using namespace std::string_literals;
using spelunk::OutsideError;

constexpr int kExitStranded = 1;
constexpr int kExitBadInput = 2;
constexpr int kExitInterrupted = 130;
constexpr int kProgressPeriod_s = 10;

/// Set by the first Ctrl-C or SIGTERM of a flight, which then ends and is written; the second one
/// ends the program.
volatile std::sig_atomic_t interrupted_by = 0;

void noteInterrupt(int number) { interrupted_by = number; }

void catchInterrupts() {
  struct sigaction action {};
  action.sa_handler = noteInterrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int number : {SIGINT, SIGTERM}) sigaction(number, &action, nullptr);
}

struct Options {
  std::string world = "long_wall";
  std::string robot = "aerial";
  std::string planner = "gbplanner";
  std::uint64_t seed = 1;
  double time_limit_s = 900.0;
  std::string out = "mission_out";
  std::string start;
  double world_scale = 0.0;  ///< 0: as the world itself says.
  std::string world_up;
  std::vector<std::string> go_to;
  std::vector<std::string> assignments;
};

/// Everything a flight needs, read and checked.
struct Loaded {
  spelunk::mission::RunConfig config;
  spelunk::sim::SimParams sim;
  spelunk::evaluation::Delays delays;
  std::unique_ptr<spelunk::planners::ExplorationPlanner> planner;
  std::string share_dir;
};

Loaded load(const Options& options) {
  Loaded loaded;
  loaded.share_dir = spelunk::mission::shareDir();
  loaded.config = spelunk::mission::loadRunConfig(
      {loaded.share_dir, options.robot, options.planner, options.assignments});
  loaded.sim = spelunk::sim::readSimParams(loaded.config.tree, loaded.config.robot);
  loaded.config.tree.read("delays", loaded.delays);
  loaded.planner =
      spelunk::planners::makePlanner(loaded.config.planner, loaded.config.tree, loaded.config.robot,
                                     loaded.config.map.resolution_m);
  loaded.config.tree.requireClean();
  return loaded;
}

/// One line a parameter; a star marks those everyone should look at.
void printTable(const std::vector<spelunk::ParamDescription>& lines) {
  for (const auto& line : lines)
    std::printf("%c %-38s %-22s [%s, %s]  %s\n",
                line.audience == spelunk::Audience::kUser ? '*' : ' ', line.name.c_str(),
                line.value.c_str(), spelunk::toText(line.bounds.min).c_str(),
                spelunk::toText(line.bounds.max).c_str(), line.text.c_str());
}

void listParams(const Options& options) {
  Loaded loaded = load(options);
  printTable(spelunk::describe("robot", loaded.config.robot));
  for (const auto& sensor : loaded.config.robot.sensor_models)
    printTable(spelunk::describe("sensor." + sensor.name, sensor));
  printTable(spelunk::describe("map", loaded.config.map));
  printTable(spelunk::describe("mission", loaded.config.mission));
  printTable(spelunk::describe("navigation", loaded.config.navigation));
  printTable(spelunk::describe("terrain", loaded.config.terrain));
  printTable(spelunk::planners::describePlanner(loaded.config.planner, loaded.config.tree,
                                                loaded.config.robot));
  printTable(spelunk::describe("sim", loaded.sim));
  printTable(spelunk::describe("delays", loaded.delays));
}

/// "x,y,z" or "x,y,z,method"; the method wins over navigation.method.
spelunk::evaluation::GoToLeg legFrom(const std::string& text,
                                     const spelunk::navigation::NavigationParams& params) {
  spelunk::evaluation::GoToLeg leg{Eigen::Vector3d::Zero(), params};
  std::string point = text;
  const std::size_t last = text.rfind(',');
  if (last != std::string::npos && std::count(text.begin(), text.end(), ',') == 3) {
    point = text.substr(0, last);
    leg.navigation.method = text.substr(last + 1);
  }
  const auto values = spelunk::evaluation::numbersIn(point, 3);
  if (!values || !leg.navigation.problems().empty())
    throw OutsideError(
        "--go-to '" + text +
        "': write it as x,y,z in metres, or x,y,z,method with adaptive, rrt_star, plain or "
        "plain_short");
  leg.target = {values->at(0), values->at(1), values->at(2)};
  return leg;
}

/// Whether lines can be written over there.
bool isTerminal() {
  const char* kind = std::getenv("TERM");
  return isatty(STDOUT_FILENO) != 0 && kind != nullptr && kind != "dumb"s;
}

/// Shows a line in place on a terminal, else one line every ten simulated seconds.
void show(const spelunk::evaluation::Progress& progress) {
  const bool terminal = isTerminal();
  const auto second = static_cast<long>(progress.t_s + 0.5);
  if (!terminal && second % kProgressPeriod_s != 0) return;
  const auto& status = progress.status;
  std::printf("%s%6.0f s  %8.0f m3  %6.1f m3/s  %-10s  endurance %5.0f s  margin %5.0f s%s",
              terminal ? "\r\x1b[K" : "", progress.t_s, progress.explored_m3, progress.rate_m3ps,
              spelunk::mission::toText(status.state), status.remaining_s, status.margin_s,
              terminal ? "" : "\n");
  std::fflush(stdout);
}

void plot(const std::string& share_dir, const std::string& out) {
  if (spelunk::evaluation::runProgram({share_dir + "/scripts/plot_mission.py", out}) != 0)
    spelunk::log(spelunk::LogLevel::kWarn,
                 "no exploration.png: scripts/plot_mission.py says why (python3-matplotlib draws)");
}

/// What was seen through cracks and holes of the mesh, if a cubic metre or more.
std::string textOfOutside(const spelunk::evaluation::RunRecord& record) {
  if (record.explored_outside_m3 < 1.0) return "";
  return " (and " + std::to_string(std::lround(record.explored_outside_m3)) +
         " m3 outside, through cracks or holes of the mesh)";
}

void sayResult(const spelunk::evaluation::RunRecord& record, const spelunk::LocalFrame& frame) {
  std::printf(
      "\n%s\nexplored %.0f m3 of %.0f m3 reachable%s on %.0f m in %.0f s "
      "(%.1f s of wall time); collisions %d; %s\n",
      frame.toCaller(record.outcome).c_str(), record.explored_volume_m3, record.reachable.total_m3,
      textOfOutside(record).c_str(), record.path_length_m, record.mission_time_s,
      record.wall_time_s, record.collisions,
      record.returned_home
          ? ("home with " + std::to_string(static_cast<int>(record.remaining_at_home_s)) +
             " s left")
                .c_str()
          : "NOT home");
}

/// Lines of the flight name places in the caller's frame, whatever frame it is flown in.
void logToTerminal(bool quiet, const spelunk::LocalFrame& frame) {
  spelunk::setLogSink([quiet, frame](spelunk::LogLevel level, const std::string& text) {
    if (!quiet || level != spelunk::LogLevel::kInfo)
      std::cerr << "\n" << frame.toCaller(text) << std::flush;
  });
}

spelunk::sim::WorldMesh openWorld(const Options& options, const Loaded& loaded) {
  return spelunk::sim::openWorld(
      options.world, loaded.share_dir + "/worlds", spelunk::sim::defaultCacheDir(),
      spelunk::sim::meshFrameOf(options.world_scale, options.world_up),
      spelunk::evaluation::surroundingsOf(options.start, loaded.config.robot, loaded.config.map,
                                          options.time_limit_s));
}

spelunk::evaluation::RunSetup setupFor(const Options& options, const Loaded& loaded,
                                       const spelunk::sim::WorldMesh& mesh) {
  spelunk::evaluation::RunSetup setup;
  setup.robot = loaded.config.robot;
  setup.sim = loaded.sim;
  setup.map = loaded.config.map;
  setup.mission = loaded.config.mission;
  setup.terrain = loaded.config.terrain;
  setup.start = spelunk::evaluation::startOf(options.start, mesh, loaded.config.robot.box_m);
  if (mesh.exploration_bounds) setup.bounds = *mesh.exploration_bounds;
  setup.seed = options.seed;
  setup.time_limit_s = options.time_limit_s;
  setup.delays = loaded.delays;
  for (const std::string& text : options.go_to) {
    auto leg = legFrom(text, loaded.config.navigation);
    leg.target = mesh.frame.written(leg.target);
    setup.legs.push_back(leg);
  }
  return setup;
}

/// Everything that is left of a flight, in the folder of the results.
void writeFiles(const Options& options, const Loaded& loaded, const spelunk::LocalFrame& frame,
                const spelunk::evaluation::RunRecord& record, spelunk::map::OccupancyMap& map) {
  spelunk::evaluation::writeReport(
      options.out,
      {options.planner, options.world, options.robot, options.seed, options.time_limit_s, frame},
      record);
  map.save(options.out + "/map.bt", frame);
  spelunk::evaluation::writePlanView(*map.freeze(), frame, options.out + "/.plan_view");
  plot(loaded.share_dir, options.out);
}

int fly(const Options& options, bool quiet) {
  const Loaded loaded = load(options);
  spelunk::evaluation::requireWritable(options.out);
  const spelunk::evaluation::FolderLock lock(options.out);
  const auto mesh = openWorld(options, loaded);
  logToTerminal(quiet, mesh.frame);
  if (const std::string text = spelunk::sayingOf(mesh.frame); !text.empty())
    spelunk::log(spelunk::LogLevel::kInfo, text);
  spelunk::evaluation::MissionRun run(setupFor(options, loaded, mesh), mesh, *loaded.planner);
  if (const auto leak = run.reachable().leak)
    spelunk::log(spelunk::LogLevel::kWarn, textOf(*leak, mesh.name));
  catchInterrupts();
  const auto record = run.fly([&](const spelunk::evaluation::Progress& progress) {
    if (!quiet) show(progress);
    if (interrupted_by != 0) run.stop("interrupted by "s + strsignal(interrupted_by));
  });
  if (!quiet) sayResult(record, mesh.frame);
  writeFiles(options, loaded, mesh.frame, record, run.mission().map());
  if (!quiet) std::printf("written to %s\n", options.out.c_str());
  if (interrupted_by != 0 && !record.returned_home) return kExitInterrupted;
  return record.ended_as_it_may ? EXIT_SUCCESS : kExitStranded;
}

}  // namespace

int main(int argc, char** argv) {
  spelunk::pinMathLibrary(argc, argv);
  std::signal(SIGPIPE, SIG_IGN);  // Who reads the progress may go away; the mission goes on.
  CLI::App app{"Flies one exploration mission in lockstep with the simulator, without ROS"};
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  Options options;
  bool list_params = false;
  bool quiet = false;
  app.add_option("--world", options.world, "name from worlds/ or path of a mesh");
  app.add_option("--robot", options.robot, "name from config/robots or path of a file like those");
  app.add_option("--planner", options.planner,
                 "exploration planner, or path of a file with its section");
  app.add_option("--seed", options.seed, "seed of the whole run")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  app.add_option("--time-limit-s", options.time_limit_s, "the robot is home before this time")
      ->check(CLI::Range(1.0, 1e6))
      ->check(spelunk::evaluation::whyNotFinite);
  app.add_option("--out", options.out, "folder for the results");
  app.add_option("--start", options.start, "x,y,z,yaw; wins over the world's own");
  app.add_option("--go-to", options.go_to,
                 "x,y,z: fly there instead of exploring; several: one after the other; "
                 "x,y,z,method says how (adaptive, rrt_star, plain, plain_short)")
      ->take_all();
  app.add_option("--world-scale", options.world_scale,
                 "metres a unit of the mesh, 0.001 for millimetres; wins over its <name>.json");
  app.add_option("--world-up", options.world_up,
                 "axis of the mesh that points up: x, y or z; wins over its <name>.json");
  app.add_option("--set", options.assignments, "section.name=value, any parameter")->take_all();
  app.add_flag("--list-params", list_params, "print all parameters and leave");
  app.add_flag("--quiet", quiet, "no progress line");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? EXIT_SUCCESS : kExitBadInput;
  }
  logToTerminal(quiet, {});
  try {
    if (list_params) return listParams(options), EXIT_SUCCESS;
    return fly(options, quiet);
  } catch (const OutsideError& error) {
    std::cerr << "\nmission: " << error.what() << '\n';
    return kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "mission: internal fault: " << error.what() << '\n';
    return kExitStranded;
  }
}
