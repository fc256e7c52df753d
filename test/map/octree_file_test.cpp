#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

class OctreeFile : public testing::Test {
 protected:
  OctreeFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "octree_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~OctreeFile() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string pathOf(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(pathOf(name), std::ios::binary) << content;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream in(pathOf(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::filesystem::path folder_;
};

std::string refusal(OccupancyMap& map, const std::string& path) {
  try {
    map.load(path);
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

void expectSameStatus(const FrozenMap& a, const FrozenMap& b) {
  EXPECT_EQ(a.freeVoxels(), b.freeVoxels());
  EXPECT_EQ(a.occupiedVoxels(), b.occupiedVoxels());
  for (int z = -8; z < 18; ++z)
    for (int y = -24; y < 28; ++y)
      for (int x = -48; x < 58; ++x)
        ASSERT_EQ(a.at(VoxelIndex(x, y, z)), b.at(VoxelIndex(x, y, z)));
}

TEST_F(OctreeFile, FullFileBringsBackTheIdenticalTree) {
  OccupancyMap map = hallMap(MapParams{}, 5, 900, 3);
  map.save(pathOf("map.ot"));
  OccupancyMap loaded{MapParams{}};
  loaded.load(pathOf("map.ot"));
  EXPECT_TRUE(loaded.octree() == map.octree());
  EXPECT_FALSE(std::filesystem::exists(pathOf("map.ot.part")));
}

TEST_F(OctreeFile, LikelyFileBringsBackTheStatus) {
  OccupancyMap map = hallMap(MapParams{}, 5, 900, 3);
  map.save(pathOf("map.bt"));
  OccupancyMap loaded{MapParams{}};
  loaded.load(pathOf("map.bt"));
  expectSameStatus(*loaded.freeze(), *map.freeze());
  loaded.save(pathOf("again.bt"));
  EXPECT_EQ(read("again.bt"), read("map.bt"));
}

TEST_F(OctreeFile, OctoMapReadsOurFiles) {
  OccupancyMap map = hallMap(MapParams{}, 5, 900, 3);
  map.save(pathOf("map.ot"));
  map.save(pathOf("map.bt"));
  const std::unique_ptr<octomap::AbstractOcTree> full(
      octomap::AbstractOcTree::read(pathOf("map.ot")));
  const auto* tree = dynamic_cast<const octomap::OcTree*>(full.get());
  ASSERT_NE(tree, nullptr);
  EXPECT_TRUE(*tree == map.octree());
  octomap::OcTree likely(pathOf("map.bt"));
  octomap::OcTree wanted(map.octree());
  wanted.setClampingThresMin(0.1192);  // OctoMap's defaults, which its reader takes
  wanted.setClampingThresMax(0.971);
  wanted.toMaxLikelihood();
  wanted.prune();
  EXPECT_TRUE(likely == wanted);
}

TEST_F(OctreeFile, WeReadOctoMapsFiles) {
  OccupancyMap map = hallMap(MapParams{}, 5, 900, 3);
  octomap::OcTree tree(map.octree());
  tree.write(pathOf("plain.ot"));
  tree.writeBinary(pathOf("plain.bt"));
  OccupancyMap loaded{MapParams{}};
  loaded.load(pathOf("plain.ot"));
  EXPECT_TRUE(loaded.octree() == map.octree());
  loaded.load(pathOf("plain.bt"));
  expectSameStatus(*loaded.freeze(), *map.freeze());
}

TEST_F(OctreeFile, EmptyMapCanBeSavedAndLoaded) {
  OccupancyMap map{MapParams{}};
  for (const char* name : {"empty.bt", "empty.ot"}) {
    map.save(pathOf(name));
    OccupancyMap loaded = hallMap(MapParams{}, 1, 100, 1);
    loaded.load(pathOf(name));
    EXPECT_EQ(loaded.freeze()->freeVoxels(), 0u);
  }
}

TEST_F(OctreeFile, MapGrowsOnAfterLoading) {
  MapParams params;
  params.range_min_m = 0.0;
  OccupancyMap map = hallMap(params, 3, 500, 3);
  map.save(pathOf("map.ot"));
  OccupancyMap loaded(params);
  EXPECT_EQ(loaded.octree().size(), 0u);
  loaded.load(pathOf("map.ot"));
  Rng rng(77);
  const Scan scan = hallScan(rng, hallPosition(5), 400);
  loaded.insert(scan, noBody());
  map.insert(scan, noBody());
  EXPECT_TRUE(loaded.octree() == map.octree());
  expectSameStatus(*loaded.freeze(), *map.freeze());
}

TEST_F(OctreeFile, RefusesAnotherResolutionWithTheRemedy) {
  MapParams coarse;
  coarse.resolution_m = 0.4;
  hallMap(coarse, 1, 100, 1).save(pathOf("coarse.bt"));
  OccupancyMap map = hallMap(MapParams{}, 1, 100, 1);
  const auto before = map.freeze();
  const std::string text = refusal(map, pathOf("coarse.bt"));
  EXPECT_NE(text.find(pathOf("coarse.bt")), std::string::npos) << text;
  EXPECT_NE(text.find("set map.resolution_m to 0.4"), std::string::npos) << text;
  EXPECT_EQ(map.freeze(), before) << "the map stays as it was";
}

TEST_F(OctreeFile, RefusesWhatIsNoOctree) {
  OccupancyMap map{MapParams{}};
  EXPECT_NE(refusal(map, pathOf("missing.bt")).find("No such file"), std::string::npos);
  write("text.bt", "hello");
  EXPECT_NE(refusal(map, pathOf("text.bt")).find("not an octree"), std::string::npos);
  write("endless.ot", "# Octomap OcTree file\nid OcTree\n");
  EXPECT_NE(refusal(map, pathOf("endless.ot")).find("header has no end"), std::string::npos);
  write("colour.ot", "# Octomap OcTree file\nid ColorOcTree\nsize 1\nres 0.2\ndata\n");
  EXPECT_NE(refusal(map, pathOf("colour.ot")).find("ColorOcTree"), std::string::npos);
  EXPECT_NE(refusal(map, pathOf("map.pcd")).find(".bt or .ot"), std::string::npos);
  EXPECT_NE(refusal(map, folder_.string() + "/.bt").find("cannot open"), std::string::npos);
}

TEST_F(OctreeFile, RefusesDamagedFilesWithoutHarm) {
  OccupancyMap map = hallMap(MapParams{}, 2, 400, 3);
  map.save(pathOf("map.bt"));
  map.save(pathOf("map.ot"));
  const auto before = map.freeze();
  for (const std::string name : {"map.bt", "map.ot"}) {
    const std::string whole = read(name);
    for (const double share : {0.2, 0.6, 0.999}) {
      const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
      write("cut_" + name, whole.substr(0, length));
      EXPECT_NE(refusal(map, pathOf("cut_" + name)).find("cut short"), std::string::npos);
    }
  }
  const std::string header = "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.2\ndata\n";
  write("deep.bt", header + std::string(200, '\xFF'));
  EXPECT_NE(refusal(map, pathOf("deep.bt")).find("deeper"), std::string::npos);
  write("huge.bt", header + std::string("\x01\x00", 2));
  EXPECT_NE(refusal(map, pathOf("huge.bt")).find("too many"), std::string::npos);
  EXPECT_EQ(map.freeze(), before);
}

TEST_F(OctreeFile, FailedSaveSaysWhyAndLeavesTheOldFile) {
  OccupancyMap map = hallMap(MapParams{}, 1, 100, 1);
  EXPECT_THROW(map.save(pathOf("missing/map.bt")), OutsideError);
  EXPECT_THROW(map.save(pathOf("map.txt")), OutsideError);
  write("map.bt", "old");
  std::filesystem::create_directory(pathOf("map.bt.part"));  // stands for any failing write
  try {
    map.save(pathOf("map.bt"));
    ADD_FAILURE();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find(pathOf("map.bt")), std::string::npos);
  }
  EXPECT_EQ(read("map.bt"), "old");
}

TEST_F(OctreeFile, FullDiskLeavesTheOldFile) {
  ASSERT_TRUE(std::filesystem::exists("/dev/full")) << "the test needs Linux's full device";
  OccupancyMap map = hallMap(MapParams{}, 1, 100, 1);
  write("map.bt", "old");
  std::filesystem::create_symlink("/dev/full", pathOf("map.bt.part"));
  try {
    map.save(pathOf("map.bt"));
    ADD_FAILURE();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
  EXPECT_EQ(read("map.bt"), "old");
}

}  // namespace
}  // namespace spelunk::map
