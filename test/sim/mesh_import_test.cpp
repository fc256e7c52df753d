#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/mesh_size.h"
#include "spelunk/sim/start_proposal.h"
#include "spelunk/sim/world_mesh.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"

namespace spelunk::sim {
namespace {

using test::TemporaryFolder;

/// The log while it lives.
class Recorder {
 public:
  Recorder() {
    setLogSink([this](LogLevel level, const std::string& text) {
      (level == LogLevel::kInfo ? infos : warnings) += text + "\n";
    });
  }
  ~Recorder() { setLogSink({}); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  std::string infos;
  std::string warnings;
};

/// An OBJ file of a box and more lines.
std::string objBox(const Eigen::Vector3f& low, const Eigen::Vector3f& high,
                   const std::string& more = "") {
  WorldMesh mesh;
  test::addBox(mesh, low, high);
  std::string text;
  for (const Eigen::Vector3f& v : mesh.vertices)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\n";
  for (const Eigen::Vector3i& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text + more;
}

template <class Call>
std::string errorOf(Call&& call) {
  try {
    call();
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

void expectBounds(const WorldMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  EXPECT_LT((mesh.bounds().min - low).norm(), 1e-5) << mesh.bounds().min.transpose();
  EXPECT_LT((mesh.bounds().max - high).norm(), 1e-5) << mesh.bounds().max.transpose();
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(MeshFrame, MillimetresAndYUpBecomeMetresAndZUp) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("mine.obj", objBox({0, -1000, 0}, {20000, 3000, 10000}));  // 4 m high along y
  expectBounds(loadWorldMesh(path, {0.001, UpAxis::kY}), {0, -10, -1}, {20, 0, 3});
  expectBounds(loadWorldMesh(path, {0.001, UpAxis::kX}), {-1, 0, 0}, {3, 10, 20});
  expectBounds(loadWorldMesh(path, {0.001, UpAxis::kZ}), {0, -1, 0}, {20, 3, 10});
}

TEST(MeshFrame, TurnsWithoutMirroring) {
  for (const UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ})
    EXPECT_NEAR((MeshFrame{2.0, up}.T_world_file().determinant()), 8.0, 1e-12);
}

TEST(MeshFrame, WhatIsToldWinsOverTheFileBesideTheMesh) {
  const TemporaryFolder folder;
  const std::string path = folder.write("mine.obj", objBox({0, 0, 0}, {20, 4, 10}));
  folder.write("mine.json", R"({"scale": 2, "up": "y", "start": [5, -8, 3, 0.5]})");
  const WorldMesh mesh = loadWorldMesh(path);
  expectBounds(mesh, {0, -20, 0}, {40, 0, 8});
  EXPECT_EQ(mesh.start->position, Eigen::Vector3d(5, -8, 3));  // as it is after scale and up
  expectBounds(loadWorldMesh(path, {3.0, std::nullopt}), {0, -30, 0}, {60, 0, 12});
  expectBounds(loadWorldMesh(path, {std::nullopt, UpAxis::kZ}), {0, 0, 0}, {40, 8, 20});
}

TEST(MeshFrame, RefusesWhatIsNoScaleOrAxis) {
  EXPECT_TRUE(meshFrameOf(0.0, "").isSilent());
  EXPECT_EQ(meshFrameOf(0.001, "Y").up, UpAxis::kY);
  EXPECT_TRUE(has(errorOf([] { (void)meshFrameOf(-1.0, ""); }), "--world-scale -1"));
  EXPECT_TRUE(has(errorOf([] { (void)meshFrameOf(0.0, "up"); }), "x, y or z"));
  EXPECT_TRUE(has(errorOf([] {
                    (void)openWorld("room", std::string(SPELUNK_SOURCE_DIR) + "/worlds", "/none",
                                    {0.001, std::nullopt});
                  }),
                  "mesh files only"));
}

TEST(Sidecar, BoundsLimitExploration) {
  const TemporaryFolder folder;
  const std::string path = folder.write("mine.obj", objBox({0, 0, 0}, {20, 10, 4}));
  for (const std::string text : {R"({"bounds": [[1, 2, 0], [9, 8, 3.5]], "artifacts": []})",
                                 R"({"bounds": [1, 2, 0, 9, 8, 3.5]})"}) {
    folder.write("mine.json", text);
    const auto bounds = loadWorldMesh(path).exploration_bounds;
    ASSERT_TRUE(bounds) << text;
    EXPECT_EQ(bounds->min, Eigen::Vector3d(1, 2, 0)) << text;
    EXPECT_EQ(bounds->max, Eigen::Vector3d(9, 8, 3.5)) << text;
  }
}

TEST(Sidecar, SaysWhichKeysItDoesNotKnow) {
  const TemporaryFolder folder;
  const std::string path = folder.write("mine.obj", objBox({0, 0, 0}, {20, 10, 4}));
  folder.write("mine.json", R"({"strat": [1, 1, 1, 0]})");
  Recorder log;
  EXPECT_FALSE(loadWorldMesh(path).start);
  EXPECT_TRUE(has(log.warnings, "mine.json: \"strat\" is not known and not used; start, scale, up"))
      << log.warnings;
}

TEST(Sidecar, RefusesWrongKindsWithTheRemedy) {
  const TemporaryFolder folder;
  const std::string path = folder.write("mine.obj", objBox({0, 0, 0}, {20, 10, 4}));
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"({"scale": "mm"})", "0.001 for millimetres"},
      {R"({"scale": 0})", "metres a unit"},
      {R"({"scale": 1e999})", "mine.json"},
      {R"({"up": "up"})", "\"x\", \"y\" or \"z\""},
      {R"({"up": 1})", "\"x\", \"y\" or \"z\""},
      {R"({"bounds": [0, 0, 0, 1, 1]})", "[[x, y, z], [x, y, z]]"},
      {R"({"bounds": [[0, 0, 0], [1, -1, 1]]})", "the lowest and the highest corner"},
      {R"({"start": {"x": 1}})", "[x, y, z, yaw]"}};
  for (const auto& [text, remedy] : cases) {
    folder.write("mine.json", text);
    const std::string error = errorOf([&] { (void)loadWorldMesh(path); });
    EXPECT_TRUE(has(error, "mine.json")) << text << ": " << error;
    EXPECT_TRUE(has(error, remedy)) << text << ": " << error;
  }
}

TEST(MeshBuilder, LeavesOutTrianglesWithoutAreaAndThoseThereTwiceAndSaysSo) {
  const TemporaryFolder folder;
  const std::string more =
      "v 10 0 0.5\nv 10 0 1.5\nv 10 0 3\nf 9 10 11\n"              // on one line
      "v 0.1 0.1 0.1\nv 0.2 0.2 0.2\nv 0.7 0.7 0.7\nf 12 13 14\n"  // the same, as rounding goes
      "v 900 900 900\nf 15 15 15\nf 15 15 1\n"                     // one point, one line
      "f 1 2 4\nf 4 1 2\nf 4 2 1\n";                               // a face of the box, and turned
  Recorder log;
  const WorldMesh mesh =
      loadWorldMesh(folder.write("mine.obj", objBox({0, 0, 0}, {20, 10, 4}, more)));
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  expectBounds(mesh, {0, 0, 0}, {20, 10, 4});
  EXPECT_TRUE(has(log.warnings, "left out 4 triangles without area and 3 that are there twice"))
      << log.warnings;
  EXPECT_TRUE(has(log.infos, "12 triangles, 20 x 10 x 4 m from (0, 0, 0) to (20, 10, 4)"))
      << log.infos;
  const MeshScene scene(mesh);
  EXPECT_GT(scene.distanceTo({10.0, 0.5, 1.5}, 5.0), 0.4);
}

TEST(MeshBuilder, KeepsThinTrianglesThatRaysMeet) {
  const TemporaryFolder folder;
  const WorldMesh mesh =
      loadWorldMesh(folder.write("thin.obj", "v 10 0 0\nv 20 0 0\nv 15 0.001 0\nf 1 2 3\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_TRUE(MeshScene(mesh).castRay({15.0, 0.0005, 1.0}, {0.0, 0.0, -1.0}, 5.0));
}

TEST(MeshBuilder, MeshOfNothingButLinesIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.write("line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n");
  EXPECT_TRUE(has(errorOf([&] { (void)loadWorldMesh(path); }), "no triangles with an area"));
}

TEST(MeshBuilder, VerticesOfNoTriangleNeitherCountNorBreakTheMesh) {
  const TemporaryFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
      "0\n0 1 2\n1e7 0 0\nnan 0 0\n3 0 1 2\n";
  expectBounds(loadWorldMesh(folder.write("a.ply", ply)), {0, 0, 0}, {1, 1, 2});
}

AxisAlignedBox sized(double x, double y, double z) { return {{0, 0, 0}, {x, y, z}}; }

TEST(SizeAdvice, GuessesTheUnit) {
  EXPECT_TRUE(has(sizeAdvice(sized(40000, 30000, 2500)), "millimetres"));
  EXPECT_TRUE(has(sizeAdvice(sized(40000, 30000, 2500)), "40 x 30 x 2.5 m"));
  EXPECT_TRUE(has(sizeAdvice(sized(40000, 30000, 2500)), "--world-scale 0.001"));
  EXPECT_TRUE(has(sizeAdvice(sized(1000, 900, 300)), "--world-scale 0.01"));
  EXPECT_TRUE(has(sizeAdvice(sized(5, 0.4, 0.04)), "--world-scale 1000"));
}

TEST(SizeAdvice, GuessesTheUpAxis) {
  EXPECT_TRUE(has(sizeAdvice(sized(100, 4, 80)), "--world-up y"));
  EXPECT_TRUE(has(sizeAdvice(sized(4, 100, 80)), "--world-up x"));
}

TEST(SizeAdvice, SaysNothingOfAMine) {
  EXPECT_EQ(sizeAdvice(sized(300, 200, 4)), "");
  EXPECT_EQ(sizeAdvice(sized(30, 3, 3.5)), "");
  EXPECT_EQ(sizeAdvice(sized(3, 2.5, 1.6)), "");
  EXPECT_EQ(sizeAdvice(sized(3000, 2000, 90)), "");
}

TEST(StartProposal, IsAFreePlaceInTheGallery) {
  WorldMesh mesh;
  mesh.name = "gallery";
  test::addBox(mesh, {100, 200, -50}, {120, 204, -47});
  const Eigen::Vector3d robot(1.1, 1.1, 0.4);
  const auto start = proposeStart(mesh, robot);
  ASSERT_TRUE(start);
  EXPECT_TRUE(mesh.bounds().contains(start->position)) << start->position.transpose();
  EXPECT_NEAR(start->position.z(), -49.0, 0.06);
  EXPECT_GT(MeshScene(mesh).boxDistance(start->position, robot, 1.0), 0.1);
  const std::string text = missingStartText(mesh, robot, "--start ");
  EXPECT_TRUE(has(text, "20 x 4 x 3 m from (100, 200, -50) to (120, 204, -47)")) << text;
  EXPECT_TRUE(has(text, "--start 1")) << text;
}

TEST(StartProposal, SaysWhenThereIsNone) {
  WorldMesh mesh;
  mesh.name = "tiny";
  test::addBox(mesh, {0, 0, 0}, {0.5, 0.5, 0.5});
  EXPECT_FALSE(proposeStart(mesh, {1.1, 1.1, 0.4}));
  EXPECT_TRUE(has(missingStartText(mesh, {1.1, 1.1, 0.4}, "--start "), "no place with room"));
}

}  // namespace
}  // namespace spelunk::sim
