#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "spelunk/common/contract.h"
#include "spelunk/sim/world_mesh.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"

namespace spelunk::sim {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

const std::string kWorlds = std::string(SPELUNK_SOURCE_DIR) + "/worlds";

fs::path onlyFileIn(const std::string& folder) {
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  return fs::directory_iterator(folder)->path();
}

bool sameMesh(const WorldMesh& a, const WorldMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles &&
         a.start->position == b.start->position && a.start->yaw == b.start->yaw && a.name == b.name;
}

TEST(OpenWorld, CachedMeshIsTheGeneratedOne) {
  const TemporaryFolder folder;
  const std::string cache = folder.at("deep/cache");
  const WorldMesh generated = openWorld("room", kWorlds, cache);
  const fs::path file = onlyFileIn(cache);
  const auto written = fs::last_write_time(file);
  const WorldMesh cached = openWorld("room", kWorlds, cache);
  EXPECT_TRUE(sameMesh(generated, cached));
  EXPECT_EQ(fs::last_write_time(onlyFileIn(cache)), written);
  EXPECT_EQ(generated.name, "room");
}

TEST(OpenWorld, DamagedCacheIsGeneratedAnew) {
  const TemporaryFolder folder;
  const std::string cache = folder.at("cache");
  const WorldMesh generated = openWorld("room", kWorlds, cache);
  const fs::path file = onlyFileIn(cache);
  const auto size = fs::file_size(file);
  fs::resize_file(file, size / 2);
  EXPECT_TRUE(sameMesh(generated, openWorld("room", kWorlds, cache)));
  EXPECT_EQ(fs::file_size(onlyFileIn(cache)), size);
}

TEST(OpenWorld, AnotherTextIsAnotherCacheFile) {
  const TemporaryFolder folder;
  fs::create_directory(folder.at("worlds"));
  fs::copy_file(kWorlds + "/room.yaml", folder.at("worlds/mine.yaml"));
  (void)openWorld("mine", folder.at("worlds"), folder.at("cache"));
  std::ofstream(folder.at("worlds/mine.yaml"), std::ios::app) << "\n# another text\n";
  (void)openWorld("mine", folder.at("worlds"), folder.at("cache"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.at("cache")), fs::directory_iterator()), 2);
}

TEST(OpenWorld, LivesWithoutACache) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "in the way of a folder");
  EXPECT_FALSE(openWorld("room", kWorlds, file + "/cache").triangles.empty());
}

TEST(OpenWorld, TakesPathsOfMeshes) {
  const TemporaryFolder folder;
  saveStl(test::boxRoom({4, 5, 6}), folder.at("box.stl"));
  EXPECT_EQ(openWorld(folder.at("box.stl"), kWorlds, folder.at("cache")).triangles.size(), 12U);
  EXPECT_FALSE(fs::exists(folder.at("cache")));
  EXPECT_THROW((void)openWorld(folder.at("absent.stl"), kWorlds, folder.at("cache")), OutsideError);
}

TEST(OpenWorld, ListsKnownNames) {
  const TemporaryFolder folder;
  try {
    (void)openWorld("atlantis", kWorlds, folder.at("cache"));
    FAIL() << "an unknown world was opened";
  } catch (const OutsideError& error) {
    const std::string text = error.what();
    for (const char* word : {"atlantis", "long_wall", "room_and_pillar", "cave"})
      EXPECT_NE(text.find(word), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace spelunk::sim
