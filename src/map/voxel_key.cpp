#include "voxel_key.h"

namespace spelunk::map {

Extent extentOf(const Mask& mask) {
  std::uint64_t plane = 0;
  unsigned z_bits = 0;
  for (unsigned z = 0; z < kBlockSide; ++z) {
    plane |= mask[z];
    if (mask[z] != 0) z_bits |= 1U << z;
  }
  unsigned x_bits = 0;
  unsigned y_bits = 0;
  for (unsigned y = 0; y < kBlockSide; ++y) {
    const auto row = static_cast<unsigned>((plane >> (kBlockSide * y)) & 0xFF);
    x_bits |= row;
    if (row != 0) y_bits |= 1U << y;
  }
  const auto lowest = [](unsigned bits) { return __builtin_ctz(bits); };
  const auto highest = [](unsigned bits) { return 31 - __builtin_clz(bits); };
  return {{lowest(x_bits), lowest(y_bits), lowest(z_bits)},
          {highest(x_bits), highest(y_bits), highest(z_bits)}};
}

}  // namespace spelunk::map
