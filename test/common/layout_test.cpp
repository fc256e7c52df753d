#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace spelunk {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Which module may include which; every module may include itself and common.
const std::map<std::string, Names>& allowedArrows() {
  static const Names kCore{"map", "terrain", "graph", "planners", "navigation", "mission", "fleet"};
  static const auto with = [](Names names, const Names& more) {
    names.insert(more.begin(), more.end());
    return names;
  };
  static const std::map<std::string, Names> kArrows{
      {"common", {}},
      {"map", {}},
      {"graph", {}},
      {"terrain", {"map"}},
      {"fleet", {"map", "graph"}},
      {"navigation", {"map", "terrain", "graph"}},
      {"planners", {"map", "terrain", "graph", "navigation"}},
      {"mission", {"planners", "navigation", "graph", "map", "terrain"}},
      {"sim", {}},
      {"visualization", kCore},
      {"evaluation", with(kCore, {"sim", "visualization"})},
      {"ros", with(kCore, {"sim", "visualization"})},
  };
  return kArrows;
}

struct Include {
  fs::path file;
  std::string module;
  std::string line;
};

std::vector<Include> includesOf(const fs::path& root) {
  std::vector<Include> found;
  for (const auto& folder : {root / "include" / "spelunk", root / "src"})
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      const std::string module = fs::relative(entry.path(), folder).begin()->string();
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);)
        if (line.rfind("#include", 0) == 0) found.push_back({entry.path(), module, line});
    }
  return found;
}

TEST(Layout, EveryIncludeFollowsAnArrow) {
  const std::regex own("#include [<\"]spelunk/([a-z]+)/.*");
  int checked = 0;
  for (const Include& include : includesOf(SPELUNK_SOURCE_DIR)) {
    std::smatch match;
    if (!std::regex_match(include.line, match, own)) continue;
    const std::string target = match[1];
    ++checked;
    if (target == include.module || target == "common") continue;
    ASSERT_TRUE(allowedArrows().count(include.module)) << "unknown module " << include.module;
    EXPECT_TRUE(allowedArrows().at(include.module).count(target))
        << include.file << " (" << include.module << ") may not include " << target;
  }
  EXPECT_GT(checked, 40) << "the test no longer finds the sources";
}

TEST(Layout, MissionKnowsPlannersByTheirInterfaceOnly) {
  const Names interface { "exploration_planner.h", "factory.h" };
  for (const Include& include : includesOf(SPELUNK_SOURCE_DIR)) {
    const auto at = include.line.find("spelunk/planners/");
    if (include.module != "mission" || at == std::string::npos) continue;
    const std::string header = include.line.substr(at + 17, include.line.rfind('"') - at - 17);
    EXPECT_TRUE(interface.count(header)) << include.file << " includes " << header;
  }
}

TEST(Layout, OnlyRosMentionsRos) {
  const std::regex ros(
      "#include [<\"](ros|tf2|tf2_ros|sensor_msgs|nav_msgs|geometry_msgs|std_msgs|"
      "std_srvs|visualization_msgs|trajectory_msgs|rosgraph_msgs)/.*");
  for (const Include& include : includesOf(SPELUNK_SOURCE_DIR)) {
    if (include.module == "ros") continue;
    EXPECT_FALSE(std::regex_match(include.line, ros)) << include.file << ": " << include.line;
  }
}

TEST(Layout, HeavyLibrariesStayInTheirModulesSources) {
  const std::map<std::string, std::string> owner{
      {"ompl/", "navigation"}, {"embree3/", "sim"}, {"assimp/", "sim"}, {"pcl/", "ros"}};
  for (const Include& include : includesOf(SPELUNK_SOURCE_DIR))
    for (const auto& [library, module] : owner) {
      if (include.line.find("<" + library) == std::string::npos) continue;
      EXPECT_EQ(include.module, module) << include.file;
      EXPECT_EQ(include.file.extension(), ".cpp") << include.file;
    }
}

}  // namespace
}  // namespace spelunk
