#include "voxel_key.h"

#include <algorithm>

namespace spelunk::map {

IndexRange centresIn(double min, double max, double resolution, IndexRange limits) {
  if (limits.first > limits.last) return {0, -1};
  const auto centre = [resolution](int index) { return (index + 0.5) * resolution; };
  const auto limited = [limits](double index) {
    return static_cast<int>(std::min(limits.last + 1.0, std::max(limits.first - 1.0, index)));
  };
  // Division rounds: the guess is off by one at most where a centre lies on the interval's end.
  int first = limited(std::floor(min / resolution - 0.5));
  while (first <= limits.last && (first < limits.first || centre(first) < min)) ++first;
  int last = limited(std::ceil(max / resolution - 0.5));
  while (last >= limits.first && (last > limits.last || centre(last) > max)) --last;
  return {first, last};
}

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
