#include "spelunk/ros/convert_octomap.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <octomap_msgs/OctomapWithPose.h>
#include <ros/message_traits.h>

#include <memory>
#include <sstream>

#include "spelunk/map/occupancy_map.h"
#include "spelunk/sim/mesh_scene.h"
#include "support/meshes.h"
#include "support/scans.h"

namespace spelunk::bridge {
namespace {

/// The map of a room after two scans.
std::unique_ptr<map::OccupancyMap> knownRoom() {
  const sim::WorldMesh mesh = test::boxRoom({8.0, 6.0, 3.0});
  const sim::MeshScene scene(mesh);
  auto map = std::make_unique<map::OccupancyMap>(map::MapParams{});
  for (const double x : {-1.0, 1.5}) {
    const Eigen::Vector3d position(x, 0.3, 1.5);
    map->insert(test::scanFrom(scene, SensorModel{}, position).scan,
                boxAround(position, {0.7, 0.7, 0.3}));
  }
  return map;
}

/// What another node does with the message.
std::unique_ptr<octomap::OcTree> rebuilt(const octomap_msgs::Octomap& message) {
  auto tree = std::make_unique<octomap::OcTree>(message.resolution);
  std::stringstream stream(std::string(message.data.begin(), message.data.end()));
  if (message.binary) {
    tree->readBinaryData(stream);
  } else {
    tree->readData(stream);
  }
  return tree;
}

TEST(ConvertOctomap, BinaryMessageHoldsWhatIsFreeAndWhatIsOccupied) {
  const auto map = knownRoom();
  const octomap::OcTree& tree = map->octree();
  const octomap_msgs::Octomap message = binaryMsg(tree, "world", ros::Time(7.0));
  EXPECT_TRUE(message.binary);
  EXPECT_EQ(message.id, "OcTree");
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.header.stamp, ros::Time(7.0));
  const auto back = rebuilt(message);
  std::size_t voxels = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf, ++voxels) {
    const octomap::OcTreeNode* node = back->search(leaf.getKey(), leaf.getDepth());
    ASSERT_NE(node, nullptr);
    ASSERT_EQ(back->isNodeOccupied(node), tree.isNodeOccupied(*leaf));
  }
  EXPECT_GT(voxels, 1000U);
  EXPECT_EQ(back->getNumLeafNodes(), tree.getNumLeafNodes()) << "nothing is known beyond that";
}

TEST(ConvertOctomap, FullMessageIsTheWholeTree) {
  const auto map = knownRoom();
  const octomap_msgs::Octomap message = fullMsg(map->octree(), "world", ros::Time(7.0));
  EXPECT_FALSE(message.binary);
  EXPECT_TRUE(*rebuilt(message) == map->octree());
}

TEST(ConvertOctomap, MessagesAreThoseThatOtherNodesKnow) {
  using ros::message_traits::datatype;
  using ros::message_traits::md5sum;
  EXPECT_STREQ(datatype<octomap_msgs::Octomap>(), "octomap_msgs/Octomap");
  EXPECT_STREQ(md5sum<octomap_msgs::Octomap>(), "9a45536b45c5e409cd49f04bb2d9999f");
  EXPECT_STREQ(datatype<octomap_msgs::OctomapWithPose>(), "octomap_msgs/OctomapWithPose");
  EXPECT_STREQ(md5sum<octomap_msgs::OctomapWithPose>(), "20b380aca6a508a657e95526cddaf618");
}

}  // namespace
}  // namespace spelunk::bridge
