#include "mapper/core/slices/patch_maker.hpp"

#include <span>
#include <utility>

namespace kintsugi::mapper {

void PatchMaker::keep(const ExtractedSurface& left) {
  for (const auto& [tile, points_W] : by_tile(left)) {
    std::vector<CloudPoint>& left_W = patches_[tile].left_W;
    left_W.insert(left_W.end(), points_W.begin(), points_W.end());
  }
}

std::vector<CloudSlice> PatchMaker::make(const PatchBatch& batch, const ExtractedSurface& in_volume,
                                         const CloudSlice& header) {
  auto present_W = by_tile(in_volume);
  std::vector<CloudSlice> slices;
  for (const PatchBatch::Patch& due : batch.patches) {
    Patch& patch = patches_[due.tile];
    CloudSlice slice = header;
    slice.kind = SliceKind::kPatch;
    slice.in_volume = due.in_volume;
    slice.points_W = due.in_volume ? patch.left_W : std::move(patch.left_W);
    if (due.in_volume) {
      const auto& points_W = present_W[due.tile];
      slice.points_W.insert(slice.points_W.end(), points_W.begin(), points_W.end());
    }
    if (patch.id != kNoId || !slice.points_W.empty()) {
      if (patch.id == kNoId) patch.id = next_id_++;
      slice.id = patch.id;
      slice.revision = ++patch.revision;
      revision_sum_ += slice.revision > 0 ? 1 : 0;
      slices.push_back(std::move(slice));
    }
    if (!due.in_volume) patches_.erase(due.tile);
  }
  if (!slices.empty()) slices.back().ends_batch = true;
  return slices;
}

std::vector<CloudSlice> PatchMaker::finish(const CloudSlice& header) {
  PatchBatch everything;
  for (const auto& [tile, patch] : patches_) everything.patches.push_back({tile, false});
  std::vector<CloudSlice> slices = make(everything, {}, header);
  CloudSlice& last = slices.emplace_back(header);
  last.kind = SliceKind::kFinal;
  last.id = next_id_;
  last.revision_sum = revision_sum_;
  return slices;
}

std::map<TileCoord, std::vector<CloudPoint>> PatchMaker::by_tile(
    const ExtractedSurface& surface) const {
  std::map<TileCoord, std::vector<CloudPoint>> tiles;
  const std::span points_W(surface.points_W);
  for (const ExtractedSurface::Block& block : surface.blocks) {
    std::vector<CloudPoint>& to = tiles[grid_.tile_of(block.coord)];
    const auto from = points_W.subspan(block.first_point, block.num_points);
    to.insert(to.end(), from.begin(), from.end());
  }
  return tiles;
}

}  // namespace kintsugi::mapper
