#include "spelunk/common/message_text.h"

#include <cstdio>

namespace spelunk {

std::string withNumber(const char* format, double value) {
  char text[200];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string placeOf(const Eigen::Vector3d& point) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.1f, %.1f, %.1f)", point.x(), point.y(), point.z());
  return text;
}

}  // namespace spelunk
