#pragma once

#include <cstdint>
#include <vector>

#include "ray_layers.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::map {

/// The voxels counted in one evaluation, as bits over the window. Kept a thread, wiped by what was
/// set, so that an evaluation never clears or allocates the whole.
class SeenCells {
 public:
  explicit SeenCells(std::size_t cells) {
    if (words().size() < cells / 64 + 1) words().resize(cells / 64 + 1, 0);
    words_ = words().data();
  }
  ~SeenCells() {
    for (const std::size_t word : touched_) words_[word] = 0;
    touched_.clear();
  }
  SeenCells(const SeenCells&) = delete;
  SeenCells& operator=(const SeenCells&) = delete;

  /// 1 if the cell is new, 0 the next time. No branch depends on it: nothing could predict it.
  std::uint64_t add(std::size_t cell) {
    std::uint64_t& word = words_[cell / 64];
    if (word == 0) touched_.push_back(cell / 64);
    const std::uint64_t is_new = ~(word >> (cell % 64)) & 1;
    word |= std::uint64_t{1} << (cell % 64);
    return is_new;
  }

 private:
  static std::vector<std::uint64_t>& words() {
    thread_local std::vector<std::uint64_t> words;
    return words;
  }
  static std::vector<std::size_t>& touched() {
    thread_local std::vector<std::size_t> touched;
    return touched;
  }
  std::uint64_t* words_ = nullptr;
  std::vector<std::size_t>& touched_ = touched();
};

/// Adds the voxels of one ray that are not among `seen`, up to the first occupied one. `start` is
/// the cell its offsets count from.
void countRayOnce(const std::uint8_t* window, std::size_t start, const std::int32_t* offsets,
                  std::size_t count, SeenCells& seen, VolumetricGain& gain);

/// The same for all rays of a sensor at once; voxels outside `reachable` end their rays. Without
/// `seen` every voxel is new: the layers of an only sensor hold each once.
void countLayersOnce(const RayLayers& layers, const std::vector<std::int32_t>& offsets,
                     const TemplateRays::Range& reachable, const std::uint8_t* cells,
                     std::size_t start, SeenCells* seen, VolumetricGain& gain);

}  // namespace spelunk::map
