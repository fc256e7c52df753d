#pragma once

#include <string>

#include "spelunk/common/box.h"

namespace spelunk::sim {

/// "20 x 10 x 4 m" for messages.
[[nodiscard]] std::string sizeText(const AxisAlignedBox& bounds);

/// "20 x 10 x 4 m from (0, 0, 0) to (20, 10, 4)" for messages.
[[nodiscard]] std::string boundsText(const AxisAlignedBox& bounds);

/// What a mesh of such a size makes one doubt, as ": in millimetres it would be 20 x 10 x 4 m; try
/// scale 0.001 ..."; empty if it looks like a mine in metres with z up. A mine's smallest extent
/// is that of its passages or halls; it is wider than high.
[[nodiscard]] std::string sizeAdvice(const AxisAlignedBox& bounds);

}  // namespace spelunk::sim
