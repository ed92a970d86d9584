#include "mapper/core/slices/patch_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kEarly = 0.9;  // of a period: the times of frames are not quite even

}  // namespace

void PatchSchedule::Config::validate() const {
  check_range("period_s", period_s, 0.0, 60.0);
  check_range("new_surface_s", new_surface_s, 1e-3, 1e3);
  check_range("longest_wait_s", longest_wait_s, 1e-3, 1e3);
  check_range("better_surface_s", better_surface_s, 1e-3, 1e3);
}

PatchSchedule::PatchSchedule(const Config& config, const TileGrid& grid, const CrossingRule& rule)
    : config_((config.validate(), config)), grid_(grid), rule_(rule) {}

bool PatchSchedule::has_surface(const TileCoord& tile) const {
  const auto found = tiles_.find(tile);
  return found != tiles_.end() && !found->second.blocks.empty();
}

void PatchSchedule::note_left(const std::vector<BlockCoord>& left, const TsdfVolume& volume) {
  std::set<TileCoord> touched;
  for (const BlockCoord& coord : left) {
    const TileCoord tile = grid_.tile_of(coord);
    touched.insert(tile);
    const auto found = tiles_.find(tile);
    if (found != tiles_.end()) found->second.blocks.erase(coord);
  }
  for (const TileCoord& tile : touched) {
    if (is_in_volume(tile, volume)) continue;
    const auto found = tiles_.find(tile);
    departed_[tile] = found == tiles_.end() ? keyframe_ : found->second.keyframe;
    tiles_.erase(tile);
  }
}

void PatchSchedule::note_returned(const TileCoord& coord, int keyframe, const TsdfVolume& volume) {
  departed_.erase(coord);
  Tile& tile = tiles_[coord];
  tile.keyframe = keyframe;
  std::vector<BlockSlot> slots;
  grid_.for_each_block(coord, [&](const BlockCoord& block_coord) {
    const BlockSlot slot = volume.find(block_coord);
    if (slot != kNoBlock && !tile.blocks.contains(block_coord)) slots.push_back(slot);
  });
  std::vector<BlockSurface> surfaces(slots.size());
  tbb::parallel_for(std::size_t{0}, slots.size(),
                    [&](std::size_t i) { surfaces[i] = BlockSurface(volume, slots[i], rule_); });
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const int num_voxels = surfaces[i].num_voxels();
    if (num_voxels == 0) continue;
    tile.blocks[volume.coord(slots[i])] = {
        .sent = surfaces[i], .now = surfaces[i], .change = {.num_in_all = num_voxels}};
  }
}

PatchBatch PatchSchedule::depart_all(const std::vector<TileCoord>& others) {
  for (const auto& [coord, tile] : tiles_) departed_.insert_or_assign(coord, tile.keyframe);
  for (const TileCoord& coord : others) departed_.emplace(coord, keyframe_);
  tiles_.clear();
  PatchBatch batch;
  for (const auto& [coord, keyframe] : std::exchange(departed_, {})) {
    batch.patches.push_back({coord, false, keyframe});
  }
  return batch;
}

std::optional<PatchBatch> PatchSchedule::next(const TsdfVolume& volume, std::int64_t utime,
                                              int keyframe) {
  if (!last_utime_) last_utime_ = utime;
  const double waited_s = 1e-6 * static_cast<double>(utime - *last_utime_);
  if (waited_s < kEarly * config_.period_s) return std::nullopt;
  last_utime_ = utime;
  keyframe_ = keyframe;
  look_at(volume);

  PatchBatch batch;
  for (const auto& [tile, seen_at] : std::exchange(departed_, {})) {
    batch.patches.push_back({tile, false, seen_at});
  }
  for (auto& [coord, tile] : tiles_) {
    tile.debt += cost_of_waiting(tile, waited_s);
    if (tile.debt < 1.0) continue;
    tile.debt = 0.0;
    for (auto& [block_coord, block] : tile.blocks) {
      block.sent = block.now;
      block.change = {.num_in_all = block.now.num_voxels()};
    }
    std::erase_if(tile.blocks,
                  [](const auto& entry) { return entry.second.sent.num_voxels() == 0; });
    batch.patches.push_back({coord, true, tile.keyframe});
  }
  if (batch.patches.empty()) return std::nullopt;
  std::ranges::stable_sort(batch.patches, {}, &PatchBatch::Patch::tile);  // departed ones first
  return batch;
}

/// Compares the blocks that were seen since the last time with what was sent of them.
void PatchSchedule::look_at(const TsdfVolume& volume) {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
    if (volume.in_use(slot) && volume.seen_since(slot, num_moves_)) slots.push_back(slot);
  }
  std::vector<BlockSurface> surfaces(slots.size());
  tbb::parallel_for(std::size_t{0}, slots.size(),
                    [&](std::size_t i) { surfaces[i] = BlockSurface(volume, slots[i], rule_); });
  std::set<TileCoord> seen;
  std::vector<Block*> blocks;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const BlockCoord& coord = volume.coord(slots[i]);
    const TileCoord tile_coord = grid_.tile_of(coord);
    seen.insert(tile_coord);
    Tile& tile = tiles_[tile_coord];
    tile.keyframe = keyframe_;
    if (surfaces[i].num_voxels() == 0 && !tile.blocks.contains(coord)) continue;
    Block& block = tile.blocks[coord];
    block.now = surfaces[i];
    blocks.push_back(&block);
  }
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    blocks[i]->change = change_between(blocks[i]->sent, blocks[i]->now);
  });
  num_moves_ = volume.num_moves();
  forget_discarded(seen, volume);
}

/// Blocks that turned out to be free space are no longer in the volume.
void PatchSchedule::forget_discarded(const std::set<TileCoord>& seen, const TsdfVolume& volume) {
  for (const TileCoord& coord : seen) {
    const auto tile = tiles_.find(coord);
    if (tile == tiles_.end()) continue;
    for (auto& [block_coord, block] : tile->second.blocks) {
      if (volume.find(block_coord) != kNoBlock) continue;
      block.now = BlockSurface();
      block.change = change_between(block.sent, block.now);
    }
  }
  std::erase_if(tiles_, [&](const auto& entry) {
    return entry.second.blocks.empty() && !is_in_volume(entry.first, volume);
  });
}

double PatchSchedule::cost_of_waiting(const Tile& tile, double waited_s) const {
  int num_new = 0;
  int num_better = 0;
  int num_in_all = 0;
  for (const auto& [coord, block] : tile.blocks) {
    num_new += block.change.num_new;
    num_better += block.change.num_better;
    num_in_all += block.change.num_in_all;
  }
  if (num_in_all == 0) return 0.0;
  const double all = num_in_all;
  double per_second = num_better / all / config_.better_surface_s;
  if (num_new > std::sqrt(all)) {
    per_second += std::max(num_new / all / config_.new_surface_s, 1.0 / config_.longest_wait_s);
  }
  return waited_s * per_second;
}

bool PatchSchedule::is_in_volume(const TileCoord& tile, const TsdfVolume& volume) const {
  bool found = false;
  grid_.for_each_block(
      tile, [&](const BlockCoord& coord) { found = found || volume.find(coord) != kNoBlock; });
  return found;
}

}  // namespace kintsugi::mapper
