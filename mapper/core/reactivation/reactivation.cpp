#include "mapper/core/reactivation/reactivation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <tbb/parallel_for.h>

#include "mapper/core/reactivation/visible_space.hpp"
#include "mapper/core/volume/blocks_around.hpp"

namespace kintsugi::mapper {
namespace {

/// An open visit belongs to what the volume holds.
bool is_here(const TileVisit& visit, int keyframe, const std::vector<bool>& is_near) {
  return visit.number == TileVisit::kOpen || is_near[keyframe];
}

}  // namespace

void Reactivation::close_departed(const PatchBatch& batch) {
  for (const PatchBatch::Patch& patch : batch.patches) {
    if (!patch.in_volume) store_.close(patch.tile, patch.keyframe);
  }
}

void Reactivation::clear_known(TsdfVolume& volume, const std::vector<BlockSlot>& leaving,
                               const PlaceOfKeyframe& place_of, const SameSurface& same) const {
  const double resolution_m = volume.config().resolution_m;
  const double block_m = kBlockSide * resolution_m;
  Eigen::AlignedBox3d box_U;
  for (const BlockSlot slot : leaving) {
    const BlockCoord& coord = volume.coord(slot);
    const Eigen::Vector3d corner_U = block_m * Eigen::Vector3d(coord.x, coord.y, coord.z);
    box_U.extend(corner_U).extend(corner_U + Eigen::Vector3d::Constant(block_m));
  }
  std::vector<Cover> covers;
  std::vector<std::vector<KeptBlock>> kept;
  const double radius = radius_m(resolution_m);
  store_.for_each([&](const TileVisit& visit, int keyframe) {
    if (visit.number == TileVisit::kOpen) return;
    const auto X_OU = place_of(keyframe);
    if (!X_OU) return;
    const Eigen::Vector3d center_U =
        X_OU->inverse(Eigen::Isometry) * center_of(visit.tile, resolution_m);
    if (box_U.exteriorDistance(center_U) > radius) return;
    covers.push_back({*X_OU, center_U, radius, {}});
    kept.push_back(store_.blocks_of(visit));
  });
  tbb::parallel_for(std::size_t{0}, covers.size(), [&](std::size_t i) {
    for (const KeptBlock& block : kept[i]) covers[i].blocks.push_back(block.copy());
  });
  clear_covered(volume, leaving, covers, same);
}

Reactivation::Returned Reactivation::take_visible(const SurfaceMap& seen_C, const Pose& X_UC,
                                                  const std::vector<bool>& is_near, int keyframe,
                                                  const TsdfVolume& volume) {
  const double resolution_m = volume.config().resolution_m;
  const double radius = radius_m(resolution_m);
  const double reach_m = volume.config().max_range_m - radius;
  // As far behind the surface as a frame asks for blocks.
  const VisibleSpace visible(seen_C.depth_m, seen_C.intrinsics, X_UC, volume.truncation_m());
  const double block_m = kBlockSide * resolution_m;
  const auto is_visible = [&](const BlockCoord& coord) {
    const Eigen::Vector3d corner_U = block_m * Eigen::Vector3d(coord.x, coord.y, coord.z);
    return visible.meets(corner_U + Eigen::Vector3d::Constant(0.5 * block_m),
                         0.5 * std::sqrt(3.0) * block_m);
  };
  std::vector<Returned::Visit> visits;
  store_.for_each([&](const TileVisit& visit, int seen_at) {
    const Eigen::Vector3d center_U = center_of(visit.tile, resolution_m);
    if ((center_U - X_UC.translation()).norm() > reach_m) return;
    if (!is_here(visit, seen_at, is_near) || !visible.meets(center_U, radius)) return;
    if (std::ranges::none_of(store_.coords_of(visit), is_visible)) return;
    const bool is_open = visit.number == TileVisit::kOpen;
    visits.push_back({visit, is_open ? keyframe : seen_at});
  });
  return take(visits, is_near, volume);
}

/// Of several visits of a tile only the open one or else the last comes back, and none of a tile in
/// which the volume holds other surface by now.
Reactivation::Returned Reactivation::take(const std::vector<Returned::Visit>& visits,
                                          const std::vector<bool>& is_near,
                                          const TsdfVolume& volume) {
  Returned returned;
  bool is_open_taken = false;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const TileVisit& visit = visits[i].visit;
    const bool is_first = i == 0 || visits[i - 1].visit.tile != visit.tile;
    const bool is_last = i + 1 == visits.size() || visits[i + 1].visit.tile != visit.tile;
    if (is_first) is_open_taken = visit.number == TileVisit::kOpen;  // open ones come first
    if (is_open_taken ? !is_first : !is_last) continue;
    const std::vector<BlockCoord> coords = store_.coords_of(visit);
    const auto is_in_volume = [&](const BlockCoord& coord) {
      return volume.find(coord) != kNoBlock;
    };
    bool is_taken = std::ranges::any_of(coords, is_in_volume);
    if (visit.number != TileVisit::kOpen) {
      tiles_.for_each_block(
          visit.tile, [&](const BlockCoord& coord) { is_taken = is_taken || is_in_volume(coord); });
    }
    if (is_taken) continue;
    returned.visits.push_back(visits[i]);
  }
  for (const Returned::Visit& visit : returned.visits) {
    std::ranges::move(store_.blocks_of(visit.visit), std::back_inserter(returned.blocks));
    store_.forget(visit.visit);
  }
  std::ranges::sort(returned.blocks, {}, &KeptBlock::coord);
  add_around(is_near, volume, returned);
  return returned;
}

void Reactivation::add_around(const std::vector<bool>& is_near, const TsdfVolume& volume,
                              Returned& returned) {
  std::set<TileCoord> tiles;
  for (const Returned::Visit& visit : returned.visits) tiles.insert(visit.visit.tile);
  const auto is_allowed = [&](const TileVisit& visit, int keyframe) {
    return is_here(visit, keyframe, is_near);
  };
  std::set<BlockCoord> seen;
  for (const KeptBlock& block : returned.blocks) {
    for_each_around(block.coord(), [&](const BlockCoord& near) {
      if (tiles.contains(tiles_.tile_of(near)) || volume.find(near) != kNoBlock) return;
      if (!seen.insert(near).second) return;
      if (const KeptBlock* const found = store_.find(near, is_allowed)) {
        returned.around.push_back(*found);
      }
    });
  }
}

bool Reactivation::has_most_of(const std::vector<BlockCoord>& places,
                               const std::vector<bool>& is_near) const {
  std::size_t num_there = 0;
  for (const BlockCoord& place : places) {
    const auto is_there = [&](const TileVisit& visit, int keyframe) {
      return visit.number != TileVisit::kOpen && is_near[keyframe];
    };
    if (store_.find(place, is_there) != nullptr) ++num_there;
  }
  return 2 * num_there > places.size();
}

std::vector<TileCoord> Reactivation::open_tiles() const {
  std::vector<TileCoord> tiles;
  store_.for_each([&](const TileVisit& visit, int /*keyframe*/) {
    if (visit.number == TileVisit::kOpen) tiles.push_back(visit.tile);
  });
  return tiles;
}

Eigen::Vector3d Reactivation::center_of(const TileCoord& tile, double resolution_m) const {
  const double side_m = tiles_.side_blocks() * kBlockSide * resolution_m;
  return side_m * (Eigen::Vector3d(tile.x, tile.y, tile.z).array() + 0.5).matrix();
}

double Reactivation::radius_m(double resolution_m) const {
  return 0.5 * std::sqrt(3.0) * tiles_.side_blocks() * kBlockSide * resolution_m;
}

}  // namespace kintsugi::mapper
