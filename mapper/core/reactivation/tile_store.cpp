#include "mapper/core/reactivation/tile_store.hpp"

#include <cmath>
#include <set>
#include <utility>

namespace kintsugi::mapper {
namespace {

/// Of the blocks that wait, each frame. A sixteenth of the volume leaves at a time, with the
/// default memory 2,700 blocks: half of them are packed within 7 frames, in 2 ms each.
constexpr double kPackedShare = 0.1;

}  // namespace

void TileStore::keep(const DetachedBlocks& left) {
  for (std::size_t i = 0; i < left.coords.size(); ++i) {
    const BlockCoord& coord = left.coords[i];
    auto block = std::make_shared<KeptBlock>(coord, *left.voxels[i], *left.colors[i], left.storage);
    to_pack_.push_back(block);
    std::shared_ptr<KeptBlock>& place = entries_[{grid_.tile_of(coord)}].blocks[coord];
    if (place) num_bytes_ -= place->bytes();
    num_bytes_ += block->bytes();
    place = std::move(block);
  }
}

std::vector<TileVisit> TileStore::expect(const std::vector<BlockCoord>& coords) {
  std::set<TileCoord> tiles;
  auto last = tiles.end();
  for (const BlockCoord& coord : coords) {
    const TileCoord tile = grid_.tile_of(coord);
    if (tiles.empty() || *last != tile) last = tiles.insert(tile).first;
  }
  std::vector<TileVisit> visits;
  for (const TileCoord& tile : tiles) {
    entries_[{tile}];
    visits.push_back({tile, num_closed_[tile]});
  }
  return visits;
}

TileStore::BlocksByTile TileStore::packed(const DetachedBlocks& left, const TileGrid& grid) {
  BlocksByTile blocks;
  for (std::size_t i = 0; i < left.coords.size(); ++i) {
    const BlockCoord& coord = left.coords[i];
    const KeptBlock block(coord, *left.voxels[i], *left.colors[i], nullptr);
    blocks[grid.tile_of(coord)][coord] = std::make_shared<KeptBlock>(block.packed());
  }
  return blocks;
}

void TileStore::keep(BlocksByTile blocks, const std::vector<TileVisit>& visits) {
  for (const TileVisit& visit : visits) {
    const auto entry = entries_.find(visit);
    if (entry == entries_.end()) continue;
    Blocks& kept = entry->second.blocks;
    num_bytes_ -= bytes_of(kept);
    Blocks& newer = blocks[visit.tile];
    newer.merge(kept);  // but for those that are there already
    kept = std::move(newer);
    num_bytes_ += bytes_of(kept);
    if (kept.empty()) erase(entry);
  }
}

void TileStore::close(const TileCoord& tile, int keyframe) {
  const int number = num_closed_[tile]++;
  auto open = entries_.extract(TileVisit{tile});
  if (open.empty()) return;
  open.key().number = number;
  open.mapped().keyframe = keyframe;
  open.mapped().age_key = next_age_key_++;
  by_age_[open.mapped().age_key] = open.key();
  entries_.insert(std::move(open));
}

std::vector<KeptBlock> TileStore::blocks_of(const TileVisit& visit) const {
  std::vector<KeptBlock> blocks;
  const auto entry = entries_.find(visit);
  if (entry == entries_.end()) return blocks;
  blocks.reserve(entry->second.blocks.size());
  for (const auto& [coord, block] : entry->second.blocks) blocks.push_back(*block);
  return blocks;
}

const KeptBlock* TileStore::find(const BlockCoord& coord, const VisitFilter& is_allowed) const {
  const TileCoord tile = grid_.tile_of(coord);
  const KeptBlock* newest = nullptr;
  for (auto entry = entries_.lower_bound({tile});
       entry != entries_.end() && entry->first.tile == tile; ++entry) {
    const auto& [visit, kept] = *entry;
    const auto block = kept.blocks.find(coord);
    if (block == kept.blocks.end() || !is_allowed(visit, kept.keyframe)) continue;
    newest = block->second.get();
    if (visit.number == TileVisit::kOpen) break;
  }
  return newest;
}

std::vector<BlockCoord> TileStore::coords_of(const TileVisit& visit) const {
  std::vector<BlockCoord> coords;
  const auto entry = entries_.find(visit);
  if (entry == entries_.end()) return coords;
  for (const auto& [coord, block] : entry->second.blocks) coords.push_back(coord);
  return coords;
}

void TileStore::tidy() {
  pack_some();
  while (num_bytes_ > max_bytes_ && !by_age_.empty()) {
    erase(entries_.find(by_age_.begin()->second));
  }
}

void TileStore::pack_some() {
  const auto count = static_cast<std::size_t>(std::ceil(kPackedShare * to_pack_.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (const auto block = to_pack_.front().lock()) {
      num_bytes_ -= block->bytes();
      *block = block->packed();
      num_bytes_ += block->bytes();
    }
    to_pack_.pop_front();
  }
}

std::optional<int> TileStore::keyframe_of(const TileVisit& visit) const {
  const auto entry = entries_.find(visit);
  if (entry == entries_.end()) return std::nullopt;
  return entry->second.keyframe;
}

void TileStore::forget(const TileVisit& visit) {
  const auto entry = entries_.find(visit);
  if (entry != entries_.end()) erase(entry);
}

void TileStore::erase(std::map<TileVisit, Entry>::iterator entry) {
  const auto& [visit, kept] = *entry;
  num_bytes_ -= bytes_of(kept.blocks);
  if (visit.number != TileVisit::kOpen) by_age_.erase(kept.age_key);
  entries_.erase(entry);
}

std::size_t TileStore::bytes_of(const Blocks& blocks) {
  std::size_t sum = 0;
  for (const auto& [coord, block] : blocks) sum += block->bytes();
  return sum;
}

}  // namespace kintsugi::mapper
