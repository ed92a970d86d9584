#include "mapper/core/reactivation/reactivation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/thread_priority.hpp"
#include "mapper/core/reactivation/visible_space.hpp"
#include "mapper/core/volume/blocks_around.hpp"

namespace kintsugi::mapper {
namespace {

/// Of device time, so that it does not depend on how fast the thread is. The thread computes for
/// less than half a second, but on a busy machine the others go first.
constexpr std::int64_t kWaits_us = 10'000'000;

/// On a thread of low priority, and on no other: those of the thread pool are for tracking.
template <typename Function>
auto in_background(Function function) {
  return std::async(std::launch::async, [function = std::move(function)]() mutable {
    lower_priority_of_thread();
    tbb::task_arena alone(1);
    auto result = [&] {
      Function captured = std::move(function);  // is destroyed on this thread, too
      return alone.execute(captured);
    }();
    return_free_memory();
    return result;
  });
}

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

void Reactivation::clear_known(TsdfVolume& volume, const std::vector<SeenBlocks>& leaving,
                               const SameSurface& same) {
  clear_covered(volume, known_in(leaving, volume.config().resolution_m).unpacked(), same);
}

std::shared_future<DetachedBlocks> Reactivation::keep_unknown(DetachedBlocks left,
                                                              const TsdfVolume::Config& volume,
                                                              const std::vector<SeenBlocks>& seen,
                                                              const SameSurface& same,
                                                              std::int64_t utime) {
  settle();
  Known known = known_in(seen, volume.resolution_m);
  std::vector<TileVisit> visits = store_.expect(left.coords);
  auto rest =
      in_background([left = std::move(left), volume, known = std::move(known), same]() mutable {
        return without_covered(std::move(left), volume, std::move(known).unpacked(), same);
      }).share();
  auto packed =
      in_background([rest, grid = tiles_] { return TileStore::packed(rest.get(), grid); });
  waiting_ = {std::move(visits), std::move(packed), utime + kWaits_us};
  return rest;
}

/// What is kept, as far as it may cover these blocks.
Reactivation::Known Reactivation::known_in(const std::vector<SeenBlocks>& seen_U,
                                           double resolution_m) {
  Known known = find_known(seen_U, resolution_m);
  const auto waits = [this](const KnownVisit& known_visit) {
    return std::ranges::binary_search(waiting_->visits, known_visit.visit);
  };
  if (!waiting_ || std::ranges::none_of(known.visits, waits)) return known;
  settle();
  return find_known(seen_U, resolution_m);
}

Reactivation::Known Reactivation::find_known(const std::vector<SeenBlocks>& seen_U,
                                             double resolution_m) const {
  const double block_m = kBlockSide * resolution_m;
  const double radius = radius_m(resolution_m);
  struct Extent {
    Eigen::AlignedBox3d box_U;
    std::set<TileCoord> tiles;
  };
  Known known;
  std::vector<Extent> extents(seen_U.size());
  for (std::size_t i = 0; i < seen_U.size(); ++i) {
    for (const BlockCoord& coord : seen_U[i].coords) {
      const Eigen::Vector3d corner_U = block_m * Eigen::Vector3d(coord.x, coord.y, coord.z);
      extents[i].box_U.extend(corner_U).extend(corner_U + Eigen::Vector3d::Constant(block_m));
      extents[i].tiles.insert(tiles_.tile_of(coord));
    }
    known.groups.push_back({seen_U[i].coords, {}});
  }
  store_.for_each([&](const TileVisit& visit, int keyframe) {
    if (visit.number == TileVisit::kOpen) return;
    std::shared_ptr<std::vector<StoredBlock>> blocks;
    for (std::size_t i = 0; i < seen_U.size(); ++i) {
      const auto X_OU_far = seen_U[i].place_of(keyframe);
      if (!X_OU_far && !extents[i].tiles.contains(visit.tile)) continue;
      const Pose X_OU = X_OU_far.value_or(Pose::Identity());
      const Eigen::Vector3d center_U =
          X_OU.inverse(Eigen::Isometry) * center_of(visit.tile, resolution_m);
      if (extents[i].box_U.exteriorDistance(center_U) > radius) continue;
      if (!blocks) blocks = std::make_shared<std::vector<StoredBlock>>();
      known.groups[i].covers.push_back({X_OU, center_U, radius, blocks, !X_OU_far});
    }
    if (blocks) known.visits.push_back({visit, store_.blocks_of(visit), std::move(blocks)});
  });
  return known;
}

std::vector<BlocksUnderCovers> Reactivation::Known::unpacked() && {
  tbb::parallel_for(std::size_t{0}, visits.size(), [&](std::size_t i) {
    for (const KeptBlock& block : visits[i].packed) visits[i].blocks->push_back(block.copy());
  });
  return std::move(groups);
}

void Reactivation::tidy(std::int64_t utime) {
  if (waiting_ && utime >= waiting_->due_utime) settle();
  store_.tidy();
}

/// Where surface that waits could be seen now.
void Reactivation::settle_near(const std::vector<bool>& is_near) {
  const auto is_seen = [&](const TileVisit& visit) {
    const auto keyframe = store_.keyframe_of(visit);
    return keyframe && is_near[*keyframe];
  };
  if (waiting_ && std::ranges::any_of(waiting_->visits, is_seen)) settle();
}

void Reactivation::settle() {
  if (!waiting_) return;
  Waiting waiting = *std::exchange(waiting_, std::nullopt);
  store_.keep(waiting.blocks.get(), waiting.visits);
}

Reactivation::Returned Reactivation::take_visible(const SurfaceMap& seen_C, const Pose& X_UC,
                                                  const std::vector<bool>& is_near, int keyframe,
                                                  const TsdfVolume& volume,
                                                  const HasSurface& has_surface) {
  settle_near(is_near);
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
  return take(visits, is_near, volume, has_surface);
}

/// Of several visits of a tile only the open one or else the last comes back, and none of a tile in
/// which the volume holds other surface by now. Blocks without surface are no reason to stay away:
/// noise allocates some a frame before the tile is visible.
Reactivation::Returned Reactivation::take(const std::vector<Returned::Visit>& visits,
                                          const std::vector<bool>& is_near,
                                          const TsdfVolume& volume, const HasSurface& has_surface) {
  Returned returned;
  bool is_open_taken = false;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const TileVisit& visit = visits[i].visit;
    const bool is_first = i == 0 || visits[i - 1].visit.tile != visit.tile;
    const bool is_last = i + 1 == visits.size() || visits[i + 1].visit.tile != visit.tile;
    if (is_first) is_open_taken = visit.number == TileVisit::kOpen;  // open ones come first
    if (is_open_taken ? !is_first : !is_last) continue;
    const auto is_in_volume = [&](const BlockCoord& coord) {
      return volume.find(coord) != kNoBlock;
    };
    const bool is_taken = visit.number == TileVisit::kOpen
                              ? std::ranges::any_of(store_.coords_of(visit), is_in_volume)
                              : has_surface(visit.tile);
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
    const TileCoord own_tile = tiles_.tile_of(block.coord());
    for_each_around(block.coord(), [&](const BlockCoord& near) {
      const TileCoord tile = tiles_.tile_of(near);
      if (tile == own_tile || tiles.contains(tile) || volume.find(near) != kNoBlock) return;
      if (!seen.insert(near).second) return;
      if (const KeptBlock* const found = store_.find(near, is_allowed)) {
        returned.around.push_back(*found);
      }
    });
  }
}

bool Reactivation::has_most_of(const std::vector<BlockCoord>& places,
                               const std::vector<bool>& is_near) {
  settle_near(is_near);
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
