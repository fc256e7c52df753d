#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

#include "bench.h"

namespace spelunk::benchmark {
namespace {

void print(const Row& row) {
  char line[512];
  std::snprintf(line, sizeof(line), "| %s | %s | %.4g %s | %.4g %s | %.1f x | %.0f x | %s (%s) |",
                row.operation.c_str(), row.against.c_str(), row.plain, row.unit.c_str(), row.ours,
                row.unit.c_str(), row.ratio(), row.floor, row.is_equal ? "equal" : "NOT EQUAL",
                row.equality.c_str());
  std::cout << line << std::endl;
}

/// Prints the rows; whether all were equal.
bool run(const std::string& mesh_path, const std::string& only) {
  const MineWalk walk(mesh_path, 40);
  std::unique_ptr<KnownMine> mine;
  const auto known = [&]() -> KnownMine& {
    if (mine == nullptr) mine = std::make_unique<KnownMine>(walk);
    return *mine;
  };
  const std::vector<std::pair<std::string, std::function<std::vector<Row>()>>> groups{
      {"map", [&] { return mapRows(walk); }},
      {"status", [&] { return statusRows(known()); }},
      {"edge", [&] { return edgeRows(known()); }},
      {"gain", [&] { return gainRows(known()); }},
      {"plan", [&] { return planRows(known()); }},
      {"lidar", [&] { return lidarRows(walk); }},
      {"terrain", [&] { return terrainRows(walk); }},
      {"navigation", [&] { return navigationRows(known()); }}};
  std::cout << "| operation | against | plain | ours | ratio | floor | answers |\n"
               "|---|---|---|---|---|---|---|"
            << std::endl;
  bool are_equal = true;
  for (const auto& [name, rows] : groups)
    if (only.empty() || only == name)
      for (const Row& row : rows()) {
        print(row);
        are_equal = are_equal && row.is_equal;
      }
  return are_equal;
}

}  // namespace
}  // namespace spelunk::benchmark

int main(int argc, char** argv) {
  CLI::App app{
      "Times the hot operations against the plain ways on a mine mesh (CPU time, one "
      "core) and fails if their answers differ."};
  std::string mesh;
  std::string only;
  app.add_option("--mesh", mesh, "mesh with <name>.json beside it that holds the start")
      ->required();
  app.add_option("--only", only, "one group of rows")
      ->check(CLI::IsMember(
          {"map", "status", "edge", "gain", "plan", "lidar", "terrain", "navigation"}));
  CLI11_PARSE(app, argc, argv);
  if (!std::filesystem::exists(mesh)) {
    std::cout << "skipped: no mesh at '" << mesh << "'" << std::endl;
    return 0;
  }
  try {
    return spelunk::benchmark::run(mesh, only) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "benchmark: " << error.what() << std::endl;
    return 2;
  }
}
