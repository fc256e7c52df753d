#pragma once

#include <Eigen/Core>
#include <string>

namespace spelunk {

/// A sentence, or a part of one, with a number in it; `format` is that of printf for one double.
[[nodiscard]] std::string withNumber(const char* format, double value);

/// A place as messages name it, metres: "(1.0, 2.0, 3.0)". moved() finds places in this form.
[[nodiscard]] std::string placeOf(const Eigen::Vector3d& point);

}  // namespace spelunk
