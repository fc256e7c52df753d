#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "spelunk/common/pin_math.h"
#include "spelunk/sim/simulator.h"
#include "support/meshes.h"
#include "support/terrain.h"
#include "support/walking.h"

namespace spelunk {
namespace {

class Hash {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    hash_ = (hash_ ^ bits) * 0x100000001B3ULL;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

/// Functions of the C library that choose a variant by the processor.
void addMathematics(Hash& hash) {
  for (int k = 1; k < 20000; ++k) {
    const double x = 1e-3 * k;
    for (const double y : {std::sin(x), std::cos(x), std::tan(x), std::exp(x), std::log(x),
                           std::atan2(x, 3.0), std::pow(x, 1.3)})
      hash.add(y);
  }
}

/// A flight with a turn and a scrape, and its scans.
void addFlight(Hash& hash) {
  RobotModel robot;
  SensorModel lidar;
  lidar.columns = 360;
  robot.sensor_models = {lidar};
  sim::Simulator sim(sim::SimParams{}, robot, test::boxRoom({30, 30, 6}), {{0, 13, 2}, 0.3}, 7);
  TrajectoryPoint target;
  target.pose = {{5.0, 14.8, 2.5}, 2.0};
  sim.follow({target});
  for (const sim::SimulatedScan& scan : sim.advanceTo(5.0))
    for (const Eigen::Vector3f& point : scan.scan.points)
      for (int k = 0; k < 3; ++k) hash.add(point[k]);
  for (int k = 0; k < 3; ++k) hash.add(sim.trueState().pose.position[k]);
  for (int k = 0; k < 4; ++k) hash.add(sim.trueState().orientation.coeffs()[k]);
}

/// A walk over rough ground, with what its camera sees.
void addWalk(Hash& hash) {
  RobotModel robot = test::walkerModel();
  SensorModel camera;
  camera.kind = "depth_camera";
  camera.fov_horizontal_deg = 80.0;
  camera.fov_vertical_deg = 50.0;
  camera.mount_pitch_deg = 30.0;
  camera.columns = 60;
  robot.sensor_models = {camera};
  sim::Simulator sim({}, robot, test::roughGround(14.0F, 8.0F, 0.4F, 2), {{0, 0, 1}, 0.3}, 7);
  sim.follow(test::walkAlong({{0, 0}, {3, 1}}, 0.5, 0.2));
  for (const sim::SimulatedScan& scan : sim.advanceTo(5.0))
    for (const Eigen::Vector3f& point : scan.scan.points)
      for (int k = 0; k < 3; ++k) hash.add(point[k]);
  for (const double angle : sim.joints().angles) hash.add(angle);
}

/// What this program prints when started with `--hash` in the environment `setting`.
std::string hashUnder(const std::string& setting) {
  const std::string self = testing::internal::GetArgvs()[0];
  const std::string command = "env " + setting + " '" + self + "' --hash";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 64> line{};
  if (pipe == nullptr || std::fgets(line.data(), line.size(), pipe.get()) == nullptr) return "";
  return line.data();
}

TEST(Repeatability, SameBitsOnAProcessorWithoutNewerInstructions) {
  const std::string here = hashUnder("-u GLIBC_TUNABLES");
  const std::string older = hashUnder("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX,-FMA");
  EXPECT_EQ(here.size(), 17U) << here;
  EXPECT_EQ(here, older);
}

TEST(Repeatability, PinnedProgramKeepsOtherTunables) {
  const std::string kept = hashUnder("GLIBC_TUNABLES=glibc.malloc.check=0");
  EXPECT_EQ(kept, hashUnder("-u GLIBC_TUNABLES"));
}

}  // namespace
}  // namespace spelunk

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--hash") {
    spelunk::pinMathLibrary(argc, argv);
    spelunk::Hash hash;
    spelunk::addMathematics(hash);
    spelunk::addFlight(hash);
    spelunk::addWalk(hash);
    std::printf("%016llx\n", static_cast<unsigned long long>(hash.value()));
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
