#include <cstdio>
#include <sstream>

#include "spelunk/visualization/draw.h"

namespace spelunk::visualization {
namespace {

constexpr std::size_t kTextColumns = 48;

std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    const bool breaks = column > 0 && column + 1 + word.size() > kTextColumns;
    if (column > 0) lines += breaks ? '\n' : ' ';
    column = breaks || column == 0 ? word.size() : column + 1 + word.size();
    lines += word;
  }
  return lines;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char line[160];
  std::snprintf(line, sizeof(line), pattern, values...);
  return line;
}

}  // namespace

std::string statusText(const mission::MissionStatus& status) {
  std::string text =
      std::string(mission::toText(status.state)) + format("   %.0f s\n", status.time_s) +
      format("explored %.0f m3, travelled %.0f m\n", status.known_volume_m3, status.distance_m) +
      format("endurance %.0f s, home %.0f s, margin %.0f s", status.remaining_s, status.way_home_s,
             status.margin_s);
  const std::string& why = status.end_reason.empty() ? status.reason : status.end_reason;
  if (!why.empty()) text += "\n" + wrapped(why);
  return text;
}

void drawStatus(const mission::MissionStatus& status, const Eigen::Vector3d& anchor,
                double text_height_m, Scene& scene) {
  Element text;
  text.layer = "status";
  text.shape = Shape::kText;
  text.size_m = text_height_m;
  text.points = {anchor};
  text.colours = {{1.0F, 1.0F, 1.0F, 1.0F}};
  text.text = statusText(status);
  scene.add(std::move(text));
}

void drawRemaining(const std::vector<planners::RemainingTarget>& remaining, Scene& scene) {
  for (const planners::RemainingTarget& target : remaining) {
    Element mark;
    mark.layer = "remaining";
    mark.shape = Shape::kCubes;
    mark.size_m = 0.6;
    mark.points = {target.position};
    mark.colours = {{0.75F, 0.3F, 1.0F, 0.9F}};
    scene.add(mark);
    mark.shape = Shape::kText;
    mark.size_m = 0.5;
    mark.points = {target.position + Eigen::Vector3d(0.0, 0.0, 0.8)};
    mark.text = target.why;
    if (!target.why.empty()) scene.add(std::move(mark));
  }
}

}  // namespace spelunk::visualization
