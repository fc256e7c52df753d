#include "spelunk/sim/world_mesh.h"

#include <gtest/gtest.h>

#include <string>

#include "spelunk/common/contract.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"

namespace spelunk::sim {
namespace {

using test::TemporaryFolder;

/// One triangle (0 0 0) (4 0 0) (0 2 1) in a Collada file, below a node moved by (1 0 0).
std::string collada(const std::string& unit, const std::string& up_axis) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00Z</created><modified>2020-01-01T00:00:00Z</modified><unit name="u" meter=")" +
         unit + R"("/><up_axis>)" + up_axis + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 4 0 0 0 2 1</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>1 0 0</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string errorOf(const std::string& path) {
  try {
    (void)loadWorldMesh(path);
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

TEST(WorldMesh, KeepsColladaOfMetresWithZUp) {
  const TemporaryFolder folder;
  const AxisAlignedBox box = loadWorldMesh(folder.write("a.dae", collada("1", "Z_UP"))).bounds();
  EXPECT_TRUE(box.min.isApprox(Eigen::Vector3d(1, 0, 0), 1e-6)) << box.min.transpose();
  EXPECT_TRUE(box.max.isApprox(Eigen::Vector3d(5, 2, 1), 1e-6)) << box.max.transpose();
}

TEST(WorldMesh, ScalesColladaUnitsToMetres) {
  const TemporaryFolder folder;
  const AxisAlignedBox box = loadWorldMesh(folder.write("a.dae", collada("0.01", "Z_UP"))).bounds();
  EXPECT_TRUE(box.min.isApprox(Eigen::Vector3d(0.01, 0, 0), 1e-6)) << box.min.transpose();
  EXPECT_TRUE(box.max.isApprox(Eigen::Vector3d(0.05, 0.02, 0.01), 1e-6)) << box.max.transpose();
}

TEST(WorldMesh, TurnsColladaWithYUpUpright) {
  const TemporaryFolder folder;
  const AxisAlignedBox box = loadWorldMesh(folder.write("a.dae", collada("1", "Y_UP"))).bounds();
  EXPECT_TRUE(box.min.isApprox(Eigen::Vector3d(1, -1, 0), 1e-6)) << box.min.transpose();
  EXPECT_TRUE(box.max.isApprox(Eigen::Vector3d(5, 0, 2), 1e-6)) << box.max.transpose();
}

TEST(WorldMesh, TurnsColladaWithXUpUpright) {
  const TemporaryFolder folder;
  const AxisAlignedBox box = loadWorldMesh(folder.write("a.dae", collada("1", "X_UP"))).bounds();
  EXPECT_NEAR(box.min.z(), 1.0, 1e-6);
  EXPECT_NEAR(box.max.z(), 5.0, 1e-6);
}

TEST(WorldMesh, TriangulatesPolygonsOfAnObj) {
  const TemporaryFolder folder;
  const WorldMesh mesh = loadWorldMesh(
      folder.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3 4\nl 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.name, "quad");
  EXPECT_DOUBLE_EQ(mesh.bounds().max.z(), 0.5);
}

TEST(WorldMesh, ReadsPly) {
  const TemporaryFolder folder;
  const WorldMesh mesh = loadWorldMesh(folder.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
      "2\n3 0 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_DOUBLE_EQ(mesh.bounds().max.z(), 2.0);
}

TEST(WorldMesh, SavedStlReadsBackWelded) {
  const TemporaryFolder folder;
  const WorldMesh room = test::boxRoom({4, 5, 6});
  saveStl(room, folder.at("room.stl"));
  const WorldMesh read = loadWorldMesh(folder.at("room.stl"));
  EXPECT_EQ(read.vertices.size(), 8U);
  EXPECT_EQ(read.triangles.size(), 12U);
  EXPECT_EQ(read.bounds().min, room.bounds().min);
  EXPECT_EQ(read.bounds().max, room.bounds().max);
  EXPECT_FALSE(read.start.has_value());
  EXPECT_THROW(saveStl(room, folder.at("no/such/folder/room.stl")), OutsideError);
}

TEST(WorldMesh, TakesStartFromTheFileBesideIt) {
  const TemporaryFolder folder;
  saveStl(test::boxRoom({4, 5, 6}), folder.at("room.stl"));
  folder.write("room.json", R"({"start": [1, -2, 1.5, 0.25]})");
  const WorldMesh mesh = loadWorldMesh(folder.at("room.stl"));
  ASSERT_TRUE(mesh.start.has_value());
  EXPECT_EQ(mesh.start->position, Eigen::Vector3d(1, -2, 1.5));
  EXPECT_EQ(mesh.start->yaw, 0.25);
}

TEST(WorldMesh, NamesABrokenStart) {
  const TemporaryFolder folder;
  saveStl(test::boxRoom({4, 5, 6}), folder.at("room.stl"));
  for (const char* text : {R"({"start": [1, 2]})", R"({"start": [1, 2, "x", 0]})", "[1", "7"}) {
    folder.write("room.json", text);
    const std::string error = errorOf(folder.at("room.stl"));
    EXPECT_NE(error.find("room.json"), std::string::npos) << text << ": " << error;
    EXPECT_NE(error.find("[x, y, z, yaw]"), std::string::npos) << error;
  }
}

TEST(WorldMesh, NamesUnusableFiles) {
  const TemporaryFolder folder;
  EXPECT_NE(errorOf(folder.at("absent.stl")).find("no such mesh"), std::string::npos);
  EXPECT_NE(errorOf(folder.write("empty.stl", "")).find("is empty"), std::string::npos);
  EXPECT_NE(errorOf(folder.write("junk.stl", "junk")).find("junk.stl"), std::string::npos);
  EXPECT_NE(errorOf(folder.write("text.xyz", "hello")).find("cannot be read"), std::string::npos);
  const std::string lines = folder.write("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n");
  EXPECT_NE(errorOf(lines).find("no triangles"), std::string::npos) << errorOf(lines);
}

TEST(WorldMesh, RefusesVerticesThatAreNotFinite) {
  const TemporaryFolder folder;
  WorldMesh room = test::boxRoom({4, 5, 6});
  room.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();
  saveStl(room, folder.at("nan.stl"));
  EXPECT_NE(errorOf(folder.at("nan.stl")).find("not finite"), std::string::npos)
      << errorOf(folder.at("nan.stl"));
}

}  // namespace
}  // namespace spelunk::sim
