#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "spelunk/common/log.h"
#include "spelunk/sim/world_mesh.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"

namespace spelunk::sim {
namespace {

using test::TemporaryFolder;

const Eigen::Vector3d kUtm(467000.0, 5420000.0, 300.0);

const std::string kSidecar = R"({"start": [467002.3, 5420000.7, 301.1, 0.5]})";

/// The lines that were logged while it lives.
class LogLines {
 public:
  LogLines() {
    setLogSink([this](LogLevel, const std::string& text) { lines_ += text + "\n"; });
  }
  ~LogLines() { setLogSink({}); }
  [[nodiscard]] const std::string& text() const { return lines_; }

 private:
  std::string lines_;
};

/// A mesh whose vertices are (0 0 0) (4.125 0 0) (0 2.3 1.7), at UTM coordinates in its file.
void expectExact(const WorldMesh& mesh) {
  EXPECT_EQ(mesh.frame.origin(), kUtm);
  ASSERT_EQ(mesh.vertices.size(), 3U);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  const auto corner = [&mesh](int k) {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[0][k])];
  };
  EXPECT_EQ(corner(0), Eigen::Vector3f(0.0F, 0.0F, 0.0F));
  EXPECT_EQ(corner(1), Eigen::Vector3f(4.125F, 0.0F, 0.0F));
  EXPECT_EQ(corner(2), Eigen::Vector3f(0.0F, 2.3F, 1.7F));
  ASSERT_TRUE(mesh.start);
  EXPECT_EQ(mesh.start->position, Eigen::Vector3d(2.3, 0.7, 1.1));
}

WorldMesh read(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  folder.write("m.json", kSidecar);
  return loadWorldMesh(folder.write(name, content));
}

const std::string kThreePoints =
    "467000.0 5420000.0 300.0\n467004.125 5420000 300\n467000 5420002.3 301.7\n";

TEST(ExactMesh, ObjAtUtmIsReadToTheLastDecimal) {
  expectExact(read("m.obj",
                   "# mine\nmtllib none.mtl\nv 467000.0 5420000.0 300.0\nv 467004.125 5420000 300\n"
                   "vn 0 0 1\nv 467000 5420002.3 301.7\nf 1 2 3\n"));
}

TEST(ExactMesh, PlyOfTextAtUtmIsReadToTheLastDecimal) {
  expectExact(read("m.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                   "end_header\n" +
                       kThreePoints + "3 0 1 2\n"));
}

TEST(ExactMesh, PlyOfDoublesAtUtmIsReadExactly) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar q\n"
      "property double x\nproperty double y\nproperty double z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const auto append = [&bytes](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const Eigen::Vector3d& point : {kUtm, Eigen::Vector3d(467004.125, 5420000, 300),
                                       Eigen::Vector3d(467000, 5420002.3, 301.7)}) {
    append(std::uint8_t{7});
    for (int k = 0; k < 3; ++k) append(point[k]);
  }
  append(std::uint8_t{3});
  for (const std::int32_t corner : {0, 1, 2}) append(corner);
  expectExact(read("m.ply", bytes));
}

TEST(ExactMesh, StlOfTextAtUtmIsReadToTheLastDecimal) {
  expectExact(
      read("m.stl",
           "solid m\n facet normal 0 0 1\n  outer loop\n   vertex 467000.0 5420000.0 300.0\n"
           "   vertex 467004.125 5420000 300\n   vertex 467000 5420002.3 301.7\n"
           "  endloop\n endfacet\nendsolid m\n"));
}

TEST(ExactMesh, BinaryStlAtUtmSaysHowCoarseItIsAndWhatToDo) {
  const TemporaryFolder folder;
  folder.write("room.json", kSidecar);
  WorldMesh room = test::boxRoom({30.0F, 8.0F, 4.0F});
  for (Eigen::Vector3f& vertex : room.vertices) vertex += kUtm.cast<float>();
  saveStl(room, folder.at("room.stl"));
  const LogLines log;
  const WorldMesh mesh = loadWorldMesh(folder.at("room.stl"));
  EXPECT_NE(log.text().find("only exact to 0.25 m"), std::string::npos) << log.text();
  EXPECT_NE(log.text().find("5420004 m"), std::string::npos) << log.text();
  EXPECT_NE(log.text().find("export it around a local origin"), std::string::npos) << log.text();
  EXPECT_LT(mesh.bounds().max.norm(), 30.0);
}

TEST(ExactMesh, TextWithTooFewDigitsIsSaidToBeCoarse) {
  const LogLines log;
  (void)read("m.obj",
             "v 467000 5.42e+06 300\nv 467004 5.42e+06 300\nv 467000 5.43e+06 302\nf 1 2 3\n");
  EXPECT_NE(log.text().find("only exact to 5e+03 m"), std::string::npos) << log.text();
}

TEST(ExactMesh, ScaleAndUpActOnTheOriginTooAndStartAndBoundsFollow) {
  const TemporaryFolder folder;
  folder.write("m.json",
               R"({"scale": 0.001, "up": "y", "start": [467002.3, 5420000.7, 301.1, 0],
                   "bounds": [[467000, 5419990, 290], [467010, 5420010, 310]]})");
  // In millimetres with y up: x, z, -y of the world.
  const LogLines log;
  const WorldMesh mesh =
      loadWorldMesh(folder.write("m.obj",
                                 "v 467000000 300000 -5420000000\nv 467004125 300000 -5420000000\n"
                                 "v 467000000 301700 -5420002300\nf 1 2 3\n"));
  expectExact(mesh);
  ASSERT_TRUE(mesh.exploration_bounds);
  EXPECT_EQ(mesh.exploration_bounds->min, Eigen::Vector3d(0, -10, -10));
  EXPECT_EQ(mesh.exploration_bounds->max, Eigen::Vector3d(10, 10, 10));
  EXPECT_NE(log.text().find("from (467000, 5420000, 300) to (467004.125, 5420002.3, 301.7)"),
            std::string::npos)
      << log.text();
}

TEST(ExactMesh, WholeFeetStayWhereTheyAre) {
  const TemporaryFolder folder;
  folder.write("m.json", R"({"scale": 0.3048})");
  const WorldMesh mesh = loadWorldMesh(
      folder.write("m.obj",
                   "v 1532152 17782152 984\nv 1532162 17782152 984\nv 1532152 17782162 984\n"
                   "f 1 2 3\n"));
  const Eigen::Vector3d first = mesh.frame.toCaller(Eigen::Vector3d(mesh.bounds().min));
  EXPECT_LT((first - 0.3048 * Eigen::Vector3d(1532152, 17782152, 984)).norm(), 1e-4);
}

TEST(ExactMesh, NearTheOriginNothingIsMovedOrSaid) {
  const TemporaryFolder folder;
  saveStl(test::boxRoom({30.0F, 8.0F, 4.0F}), folder.at("room.stl"));
  const LogLines log;
  const WorldMesh mesh = loadWorldMesh(folder.at("room.stl"));
  EXPECT_TRUE(mesh.frame.isCallers());
  EXPECT_EQ(mesh.bounds().max, Eigen::Vector3d(15.0, 4.0, 4.0));
  EXPECT_EQ(log.text().find("exact"), std::string::npos) << log.text();
}

TEST(ExactMesh, StartThatIsGivenDecidesTheFrameAndGeneratedVerticesFollow) {
  const TemporaryFolder folder;
  saveStl(test::boxRoom({400.0F, 8.0F, 4.0F}), folder.at("room.stl"));
  Surroundings around;
  around.start = Eigen::Vector3d(-190.0, 0.0, 2.0);
  around.range_m = 100.0;  // as of a map with very small voxels
  const WorldMesh mesh = loadWorldMesh(folder.at("room.stl"), {}, around);
  EXPECT_EQ(mesh.frame.origin(), Eigen::Vector3d(-200.0, 0.0, 0.0));
  EXPECT_EQ(mesh.bounds().min, Eigen::Vector3d(0.0, -4.0, 0.0));
}

}  // namespace
}  // namespace spelunk::sim
