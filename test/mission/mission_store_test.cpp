#include "spelunk/mission/mission_store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "spelunk/common/contract.h"
#include "support/temporary_folder.h"

namespace spelunk::mission {
namespace {

MissionRecord sample() {
  MissionRecord record;
  record.bounds.min = {-10.0, -20.0, -std::numeric_limits<double>::infinity()};
  record.bounds.max.x() = 30.0;
  record.given_zones.push_back({"shaft", {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}, -2.0, 4.0});
  record.marked_zones.push_back({"hole", {{5.0, 0.0}, {6.0, 0.0}, {6.0, 1.0}}, -1.0, 1.0});
  record.trail = {{{1.0, 2.0, 3.0}, 0.5}, {{1.5, 2.0, 3.0}, 0.6}};
  record.remaining_s = 321.5;
  planners::GraphLayer layer;
  layer.name = "global";
  layer.vertices = {{{0.0, 0.0, 1.0}, 12.5, true}, {{1.0, 0.0, 1.0}, 0.0, false}};
  layer.edges = {{0U, 1U}};
  record.graph.layers.push_back(layer);
  return record;
}

TEST(MissionStore, ReadsWhatItWrote) {
  const test::TemporaryFolder folder;
  writeRecord(folder.at("saved"), sample());
  const MissionRecord read = readRecord(folder.at("saved"));
  EXPECT_EQ(read.bounds.min.y(), -20.0);
  EXPECT_TRUE(std::isinf(read.bounds.min.z()));
  EXPECT_TRUE(std::isinf(read.bounds.max.z()));
  ASSERT_EQ(read.given_zones.size(), 1U);
  EXPECT_EQ(read.given_zones[0].name, "shaft");
  EXPECT_EQ(read.given_zones[0].polygon.size(), 3U);
  ASSERT_EQ(read.marked_zones.size(), 1U);
  EXPECT_EQ(read.marked_zones[0].name, "hole");
  EXPECT_EQ(read.marked_zones[0].z_max, 1.0);
  ASSERT_EQ(read.trail.size(), 2U);
  EXPECT_EQ(read.trail[1].yaw, 0.6);
  EXPECT_EQ(read.remaining_s, 321.5);
  ASSERT_EQ(read.graph.layers.size(), 1U);
  EXPECT_TRUE(read.graph.layers[0].vertices[0].is_frontier);
  EXPECT_EQ(read.graph.layers[0].edges[0].second, 1U);
}

TEST(MissionStore, KeepsTheFrameAndWritesPlacesOfTheCaller) {
  const test::TemporaryFolder folder;
  MissionRecord record = sample();
  record.frame = LocalFrame({467000.0, 5420000.0, 300.0});
  writeRecord(folder.at("saved"), record);
  const auto json = nlohmann::json::parse(std::ifstream(folder.at("saved/mission.json")));
  EXPECT_EQ(json["trail"][0], nlohmann::json({467001.0, 5420002.0, 303.0, 0.5}));
  EXPECT_EQ(json["bounds"]["min"][0], 466990.0);
  EXPECT_TRUE(json["bounds"]["min"][2].is_null());
  const MissionRecord read = readRecord(folder.at("saved"));
  EXPECT_EQ(read.frame, record.frame);
  EXPECT_EQ(read.trail[1].position, record.trail[1].position);
  EXPECT_EQ(read.bounds.min, record.bounds.min);
  EXPECT_EQ(read.given_zones[0].polygon[1], record.given_zones[0].polygon[1]);
  EXPECT_EQ(read.marked_zones[0].z_max, record.marked_zones[0].z_max);
  EXPECT_EQ(read.graph.layers[0].vertices[1].position, record.graph.layers[0].vertices[1].position);
}

TEST(MissionStore, NamesTheMissingFile) {
  const test::TemporaryFolder folder;
  try {
    static_cast<void>(readRecord(folder.at("nothing")));
    FAIL();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("mission.json"), std::string::npos);
  }
}

TEST(MissionStore, RefusesDamagedFiles) {
  const test::TemporaryFolder folder;
  folder.write("mission.json", "{\"format\": 1, \"trail\": [");
  EXPECT_THROW(static_cast<void>(readRecord(folder.at(""))), OutsideError);
  folder.write("mission.json", "{\"format\": 99}");
  EXPECT_THROW(static_cast<void>(readRecord(folder.at(""))), OutsideError);
}

TEST(MissionStore, TakesZonesOfEarlierFilesForPeoples) {
  const test::TemporaryFolder folder;
  folder.write("mission.json",
               R"({"format": 1, "remaining_s": 1, "trail": [], "graph": [],
                   "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},
                   "zones": [{"name": "shaft", "polygon": [[0, 0], [1, 0], [1, 1]],
                              "z_min": null, "z_max": null}]})");
  const MissionRecord read = readRecord(folder.at(""));
  EXPECT_EQ(read.given_zones.size(), 1U);
  EXPECT_TRUE(read.marked_zones.empty());
}

TEST(MissionStore, NamesFolderThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  folder.write("file", "x");
  EXPECT_THROW(writeRecord(folder.at("file/below"), sample()), OutsideError);
}

}  // namespace
}  // namespace spelunk::mission
