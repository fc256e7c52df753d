#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/posture.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/common/scan.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/motion_reference.h"
#include "spelunk/sim/walker_params.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// Parameters of the simulated world and robot's body (section "sim").
struct SimParams {
  double physics_rate_hz = 400.0;
  double mass_kg = 3.5;
  Eigen::Vector3d inertia_kgm2{0.06, 0.06, 0.10};
  Eigen::Vector3d body_m{0.7, 0.7, 0.3};  ///< Collision body; smaller than the robot's safety box.
  int rotors = 4;                         ///< 4 or 6
  double rotor_arm_m = 0.3;
  double rotor_lag_s = 0.04;
  double thrust_to_weight = 2.2;
  double drag_coefficient = 0.25;  ///< N s/m, linear.
  double hover_power_w = 350.0;
  double motion_power_w_per_mps2 = 12.0;  ///< Added times speed squared.
  double battery_wh = 0.0;                ///< 0: what robot.endurance_s at cruising speed needs.
  double dust_returns = 0.0;              ///< Mean share of rays that end early in dust.
  double self_returns_m = 0.0;            ///< Radius of a hoop around the robot that it sees.
  double odometry_drift = 0.0;            ///< Metres of drift a metre flown (1 sigma).
  double odometry_noise_m = 0.0;          ///< White noise of the position (1 sigma).
  /// When somebody's SLAM corrects the odometry (loop closures); 0: never.
  Eigen::Vector3d odometry_jumps_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d odometry_jump_m = Eigen::Vector3d::Zero();  ///< By so much, each time.
  double odometry_jump_deg = 0.0;                             ///< And turned about the robot.
  std::vector<std::string> events;                            ///< See WorldEvents.
  WalkerParams walker;  ///< Body of a legged robot (section "walker").

  /// Broken rules between fields, one text each; empty if all is well. The walker's are apart.
  [[nodiscard]] std::vector<std::string> problems() const;
  /// Where the simulated body contradicts what planner and mission know of the robot.
  [[nodiscard]] std::vector<std::string> problemsFor(const RobotModel& robot) const;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("physics_rate_hz", physics_rate_hz, Bounds{100.0, 4000.0}, "fixed steps a second");
    field("mass_kg", mass_kg, Bounds{0.1, 200.0}, "mass of the robot");
    field("inertia_kgm2", inertia_kgm2, Bounds{1e-4, 100.0}, "principal moments of inertia");
    field("body_m", body_m, Bounds{0.05, 10.0},
          "box that collides with the mesh; follows from robot.box_m where it is left out");
    field("rotors", rotors, Bounds{4, 6}, "4 or 6");
    field("rotor_arm_m", rotor_arm_m, Bounds{0.05, 3.0}, "rotor axis to centre");
    field("rotor_lag_s", rotor_lag_s, Bounds{0.0, 1.0}, "time constant of a rotor");
    field("thrust_to_weight", thrust_to_weight, Bounds{1.1, 10.0}, "all rotors at full");
    field("drag_coefficient", drag_coefficient, Bounds{0.0, 20.0}, "N s/m");
    field("hover_power_w", hover_power_w, Bounds{1.0, 1e4}, "electrical, hovering");
    field("motion_power_w_per_mps2", motion_power_w_per_mps2, Bounds{0.0, 1e4},
          "times speed squared");
    field("battery_wh", battery_wh, Bounds{0.0, 1e5}, "0: from robot.endurance_s");
    field("dust_returns", dust_returns, Bounds{0.0, 1.0}, "share of rays that dust returns");
    field("self_returns_m", self_returns_m, Bounds{0.0, 5.0},
          "radius of a hoop of the robot, 0.1 m high, in the way of its sensors; 0: none");
    field("odometry_drift", odometry_drift, Bounds{0.0, 0.2}, "m a metre, 1 sigma");
    field("odometry_noise_m", odometry_noise_m, Bounds{0.0, 1.0}, "white, 1 sigma");
    field("odometry_jumps_s", odometry_jumps_s, Bounds{0.0, 1e5},
          "three times at which a SLAM corrects the odometry; 0: never");
    field("odometry_jump_m", odometry_jump_m, Bounds{-100.0, 100.0}, "by so much, each time");
    field("odometry_jump_deg", odometry_jump_deg, Bounds{-180.0, 180.0},
          "and turned about the robot");
    field("events", events, Bounds{},
          "what appears under way: 'fall T D', 'person T D': at T s, D m back on the robot's way");
  }
};

/// The body that collides where nobody says another: the safety box less its margin, in the
/// proportions of the shipped multirotor, to the millimetre.
[[nodiscard]] Eigen::Vector3d bodyWithin(const Eigen::Vector3d& box_m);

/// Reads the sections "sim" and "walker"; problems are added to the tree.
[[nodiscard]] SimParams readSimParams(ParamTree& tree);
/// The same for a robot that is to be simulated: its body must fit into the box it plans with, and
/// follows from that box where it is not given.
[[nodiscard]] SimParams readSimParams(ParamTree& tree, const RobotModel& robot);

struct BatteryState {
  double energy_wh = 0.0;
  double fraction = 1.0;  ///< 0 .. 1
  double power_w = 0.0;
  double remaining_s = 0.0;  ///< At the present mean power.
};

struct CollisionCount {
  int episodes = 0;      ///< Contacts with the mesh, each counted once until parted for 0.5 s.
  double seconds = 0.0;  ///< Time in contact.
};

/// What went wrong with a walking robot; its trunk's contacts are CollisionCount's.
struct WalkerCount {
  int falls = 0;  ///< 0 or 1: who has fallen lies there.
  int slips = 0;  ///< Feet that slid by 3 cm or more, once a step.
  int trips = 0;  ///< Swinging feet that ran into rock.
};

/// A foot of a walking robot.
struct FootState {
  std::string name;                                    ///< LF, RF, LH, RH
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Base frame.
  bool is_in_contact = false;                          ///< It stands on the ground.
};

/// Joint angles in the order of the names, radians.
struct JointState {
  std::vector<std::string> names;
  std::vector<double> angles;
};

/// What became of a drive command.
struct DriveAnswer {
  DriveCommand executed;  ///< Within the robot's limits.
  std::string warning;    ///< What was reduced to which limit; empty if nothing was.
};

/// One scan with every simulated ray, for the mapping robot and for the referee.
struct SimulatedScan {
  Scan scan;  ///< What the robot gets (odometry's pose, noisy hits).
  Eigen::Isometry3d T_world_sensor_true = Eigen::Isometry3d::Identity();
  std::shared_ptr<const std::vector<Eigen::Vector3f>> directions;  ///< Sensor frame.
  std::vector<float> true_ranges;  ///< One a direction; range_max where nothing was hit.
  float range_max_m = 0.0F;
};

/// A robot in a mesh: fixed-step rigid-body physics, sensors, battery, odometry. The same seed and
/// commands give the same run, bit by bit. Knows nothing of planners and maps.
class Simulator {
 public:
  /// Throws OutsideError if the start lies in collision or outside the mesh's bounds, the mesh is
  /// empty or `params` have problems. An aerial robot starts hovering at `start`, at time 0; a
  /// legged one standing on the ground below it, which must be within 1.5 m, whole under its feet
  /// and not too steep.
  Simulator(const SimParams& params, const RobotModel& robot, const WorldMesh& mesh,
            const Pose& start, std::uint64_t seed);
  ~Simulator();

  /// The robot follows `trajectory` (times in this simulator's time) until told otherwise; an empty
  /// one brakes with robot.braking_deceleration_mps2 and holds. It steers by its odometry, whose
  /// frame the trajectory is in, so drift moves the robot. Throws Precondition if a point is not
  /// finite or times do not rise.
  /// A legged robot stays on the ground whatever the trajectory's height, and lets the
  /// trajectory wait for it where it cannot keep up.
  void follow(Trajectory trajectory);

  /// The robot moves at `command` (base frame) for kDriveTimeout unless told anew, then brakes and
  /// holds. What exceeds the robot's limits is reduced to them, said and counted. Throws
  /// Precondition if the command is not finite.
  DriveAnswer drive(const DriveCommand& command);
  /// How a robot with legs waits from now on: one that lies down is to hold before. Others stay as
  /// they are.
  void take(Posture posture);

  [[nodiscard]] int reducedDrives() const;  ///< Drive commands above the limits so far.

  /// From now on only scans that enter a map are cast and returned (SensorModel::mapping_period_s):
  /// the same ones, bit by bit, as among all of them.
  void castOnlyMappedScans();

  /// Advances by fixed steps up to `time_s`; returns the scans that fell due, in order of time, the
  /// first one at time 0. With an empty battery the rotors stop, the legs go limp.
  std::vector<SimulatedScan> advanceTo(double time_s);

  [[nodiscard]] double time() const;
  [[nodiscard]] RobotState trueState() const;
  [[nodiscard]] RobotState odometry() const;
  [[nodiscard]] BatteryState battery() const;
  [[nodiscard]] CollisionCount collisions() const;
  [[nodiscard]] const MeshScene& scene() const;
  [[nodiscard]] Eigen::Vector3d bodySize() const;  ///< Full extents of the body that collides.

  [[nodiscard]] WalkerCount walkerCount() const;      ///< Zeros for an aerial robot.
  [[nodiscard]] JointState joints() const;            ///< Empty for an aerial robot.
  [[nodiscard]] std::vector<FootState> feet() const;  ///< Empty for an aerial robot.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::sim
