#pragma once

#include <octomap/OcTree.h>

#include "block_map.h"

namespace spelunk::map {

/// An OcTree that is brought up to date block by block: one descent and one way up, with pruning, a
/// block. The result equals the tree OctoMap builds voxel by voxel, inner nodes included.
class OcTreeMirror : public octomap::OcTree {
 public:
  explicit OcTreeMirror(const MapParams& params);

  /// Enters the stale voxels of `block`.
  void update(const VoxelBlock& block);

  /// Enters every known voxel of `block` as surely free or surely occupied.
  void updateMaximumLikelihood(const VoxelBlock& block);

 private:
  struct Source;
  void enter(const Source& source);
  octomap::OcTreeNode* childFor(octomap::OcTreeNode* node, unsigned child, bool& is_new);
  void descend(octomap::OcTreeNode* node, bool is_new, unsigned depth, const Source& source);
  void fillCube(octomap::OcTreeNode* node, bool is_new, int first_voxel, int side,
                const Source& source);
  void fillChildren(octomap::OcTreeNode* node, int first_voxel, int side, const Source& source);
  void collapse(octomap::OcTreeNode* node, float value);
  void finish(octomap::OcTreeNode* node);
};

}  // namespace spelunk::map
