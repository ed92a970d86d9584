#pragma once
// The surface of a map, found by place.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include <oneapi/tbb/concurrent_unordered_map.h>

#include "segmenter/objects/recognition/labelled_map.hpp"
#include "segmenter/objects/recognition/surface_grid.hpp"

namespace kintsugi::segmenter {

/// Blocks of the map are made into surface when they are first looked at: most of a map is floor
/// and walls, where nobody looks for objects. Several threads may look at once, while nobody
/// changes it.
class SceneSurface {
 public:
  /// `map` must outlive this. @param resolution_m voxel size of the map, > 0
  SceneSurface(const LabelledMap& map, float resolution_m)
      : map_(map), resolution_m_(resolution_m) {}

  /// All colours are multiplied by this (red, green, blue).
  void set_gain(const Eigen::Array3f& gain);
  /// The points of these blocks have changed.
  void forget(const std::set<BlockKey>& blocks);

  /// Calls visit(const SurfacePoint&, segment id) for each point in the box.
  template <class Visit>
  void visit(const Eigen::AlignedBox3f& box_W, const Visit& visit) const;

  /// The nearest point that is at most `within_m` from `p_W` and wanted; nullptr: there is none.
  template <class IsWanted>
  [[nodiscard]] const SurfacePoint* nearest(const Eigen::Vector3f& p_W, float within_m,
                                            const IsWanted& is_wanted) const;

 private:
  struct Block {
    std::vector<LabelledMap::PointRef> refs;  // of each point of the surface
    SurfaceGrid grid_W;
  };

  [[nodiscard]] const Block* block(const BlockKey& key) const;
  [[nodiscard]] Block made(const BlockKey& key) const;
  template <class Visit>
  void visit_blocks(const Eigen::AlignedBox3f& box_W, const Visit& visit) const;

  const LabelledMap& map_;
  float resolution_m_;
  Eigen::Array3f gain_ = Eigen::Array3f::Ones();
  mutable oneapi::tbb::concurrent_unordered_map<BlockKey, Block, BlockKeyHash> blocks_;
};

template <class Visit>
void SceneSurface::visit_blocks(const Eigen::AlignedBox3f& box_W, const Visit& visit) const {
  const BlockKey low = map_.block_of(box_W.min());
  const BlockKey high = map_.block_of(box_W.max());
  for (std::int32_t z = low[2]; z <= high[2]; ++z) {
    for (std::int32_t y = low[1]; y <= high[1]; ++y) {
      for (std::int32_t x = low[0]; x <= high[0]; ++x) {
        if (const Block* const found = block({x, y, z})) visit(*found);
      }
    }
  }
}

template <class Visit>
void SceneSurface::visit(const Eigen::AlignedBox3f& box_W, const Visit& visit) const {
  visit_blocks(box_W, [&](const Block& block) {
    const Surface& surface_W = block.grid_W.surface();
    std::int32_t piece = 0;
    std::span<const std::uint32_t> labels;  // of this piece, once one of its points was found
    for (std::size_t i = 0; i < surface_W.size(); ++i) {
      if (!box_W.contains(surface_W[i].position)) continue;
      const LabelledMap::PointRef& ref = block.refs[i];
      if (labels.empty() || ref.piece != piece) {
        piece = ref.piece;
        labels = map_.labels_of_piece(piece);
      }
      visit(surface_W[i], labels[ref.index]);
    }
  });
}

template <class IsWanted>
const SurfacePoint* SceneSurface::nearest(const Eigen::Vector3f& p_W, float within_m,
                                          const IsWanted& is_wanted) const {
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(within_m);
  const SurfacePoint* nearest = nullptr;
  float least_m2 = 0.0F;
  visit_blocks({p_W - reach, p_W + reach}, [&](const Block& block) {
    const NearestPoint found = block.grid_W.nearest(p_W, within_m, is_wanted);
    if (found.index < 0 || (nearest != nullptr && found.squared_m2 >= least_m2)) return;
    nearest = &block.grid_W.surface()[static_cast<std::size_t>(found.index)];
    least_m2 = found.squared_m2;
  });
  return nearest;
}

}  // namespace kintsugi::segmenter
