#include "bit_grid.h"

#include <algorithm>
#include <cstring>

namespace spelunk::map {
namespace {

/// Every other bit of 32, from the lowest on, moved together.
std::uint64_t everyOther(std::uint64_t bits) {
  bits &= 0x55555555u;
  bits = (bits | (bits >> 1)) & 0x33333333u;
  bits = (bits | (bits >> 2)) & 0x0F0F0F0Fu;
  bits = (bits | (bits >> 4)) & 0x00FF00FFu;
  return (bits | (bits >> 8)) & 0x0000FFFFu;
}

/// Bits first..last of one word of a row, where the word starts at bit `start`.
std::uint64_t wordMask(int first, int last, int start) {
  const int low = std::max(first - start, 0);
  const int high = std::min(last - start, 63);
  return (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (63 - high));
}

}  // namespace

BitGrid::BitGrid(const LocalWindow& window, Occupancy status) {
  static_assert(static_cast<int>(Occupancy::kFree) == 1 &&
                static_cast<int>(Occupancy::kOccupied) == 2);
  enter(window, status == Occupancy::kFree ? 0 : 1, 0);
}

BitGrid BitGrid::notOccupied(const LocalWindow& window) {
  BitGrid grid;
  grid.enter(window, 1, ~std::uint64_t{0});
  return grid;
}

/// Takes one of the two bits of each cell's status, xor `flip`.
void BitGrid::enter(const LocalWindow& window, unsigned status_bit, std::uint64_t flip) {
  size_ = window.size();
  row_words_ = (static_cast<std::size_t>(size_.x()) + 63) / 64;
  words_.assign(
      row_words_ * static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z()), 0);
  const auto length = static_cast<std::size_t>(size_.x());
  const std::uint8_t* packed = window.packedCells().data();
  std::size_t cell = 0;
  for (std::size_t row = 0; row < words_.size(); row += row_words_, cell += length)
    for (std::size_t x = 0; x < length; x += 16) {
      const std::size_t at = cell + x;
      std::uint64_t pairs;
      std::memcpy(&pairs, packed + at / 4, sizeof(pairs));
      const std::uint64_t bits = everyOther(pairs >> (2 * (at % 4) + status_bit)) ^ flip;
      const std::size_t count = std::min<std::size_t>(16, length - x);
      words_[row + x / 64] |= (bits & ((1u << count) - 1)) << (x % 64);
    }
}

bool BitGrid::isAnySet(const VoxelIndex& first, const VoxelIndex& last) const {
  const VoxelIndex from = first.cwiseMax(0);
  const VoxelIndex to = last.cwiseMin(size_ - VoxelIndex::Ones());
  if (from.x() > to.x()) return false;
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y)
      for (int start = from.x() & ~63; start <= to.x(); start += 64)
        if ((words_[rowOf(y, z) + static_cast<unsigned>(start) / 64] &
             wordMask(from.x(), to.x(), start)) != 0)
          return true;
  return false;
}

bool BitGrid::areAllSet(const VoxelIndex& first, const VoxelIndex& last) const {
  if ((first.array() < 0).any() || (last.array() >= size_.array()).any()) return false;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int start = first.x() & ~63; start <= last.x(); start += 64)
        if ((~words_[rowOf(y, z) + static_cast<unsigned>(start) / 64] &
             wordMask(first.x(), last.x(), start)) != 0)
          return false;
  return true;
}

void BitGrid::andShiftedInRows(std::size_t shift) {
  const std::size_t skip = shift / 64;
  const auto bits = static_cast<unsigned>(shift % 64);
  for (std::size_t row = 0; row < words_.size(); row += row_words_) {
    std::uint64_t* words = words_.data() + row;
    for (std::size_t i = 0; i < row_words_; ++i) {
      const std::uint64_t low = i + skip < row_words_ ? words[i + skip] : 0;
      const std::uint64_t high = i + skip + 1 < row_words_ ? words[i + skip + 1] : 0;
      words[i] &= bits == 0 ? low : (low >> bits) | (high << (64 - bits));
    }
  }
}

void BitGrid::andShifted(int axis, int shift) {
  const auto by = static_cast<std::size_t>(shift);
  if (axis == 0) {
    andShiftedInRows(by);
    return;
  }
  // A shift in y stays inside a plane, one in z runs over the whole grid.
  const std::size_t plane = row_words_ * static_cast<std::size_t>(size_.y());
  const std::size_t span = axis == 1 ? plane : words_.size();
  const std::size_t offset = by * (axis == 1 ? row_words_ : plane);
  for (std::size_t start = 0; start < words_.size(); start += span) {
    std::uint64_t* words = words_.data() + start;
    const std::size_t kept = offset < span ? span - offset : 0;
    for (std::size_t i = 0; i < kept; ++i) words[i] &= words[i + offset];
    std::fill(words + kept, words + span, 0);
  }
}

void BitGrid::erode(int axis, int length) {
  for (int done = 1; done < length;) {
    const int shift = std::min(done, length - done);
    andShifted(axis, shift);
    done += shift;
  }
}

}  // namespace spelunk::map
