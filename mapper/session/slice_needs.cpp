#include "mapper/session/slice_needs.hpp"

#include <algorithm>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::mapper {

SliceNeeds::SliceNeeds(const SessionContents& contents, const Read& read) : read_(read) {
  for (const auto& [sequence, slice] : contents.slices) {
    if (slice.superseded || !slice.is_whole()) continue;
    const PlacedSlice*& newest = newest_[slice.id];
    if (newest == nullptr || slice.revision > newest->revision) newest = &slice;
  }
  for (const auto& [sequence, slice] : contents.slices) {
    if (slice.kind != SliceKind::kCorrection || !slice.is_whole()) continue;
    const CloudSlice correction = whole(slice);
    for (const PatchMotion& motion : correction.motions) {
      std::int32_t& number = placed_by_[motion.id];
      number = std::max(number, correction.correction);
    }
    std::int32_t& last = last_with_loops_of_[correction.part];
    last = std::max(last, correction.correction);
  }
  for (auto& [id, number] : placed_by_) {
    const auto patch = newest_.find(id);
    if (patch == newest_.end()) continue;
    // The header counts on a tie.
    const auto chunk = decode_chunk<CloudSlice>(read_(patch->second->chunks.front()->place));
    if (chunk.header.correction >= number) number = 0;
  }
}

SliceNeeds::Need SliceNeeds::need(const PlacedSlice& slice) const {
  const auto newest = newest_.find(slice.id);
  if (newest != newest_.end() && newest->second->revision > slice.revision) return Need::kNone;
  if (slice.kind != SliceKind::kCorrection || !slice.is_whole()) return Need::kWhole;
  const CloudSlice before = whole(slice);
  CloudSlice after = before;
  shorten(after);
  const bool is_shorter =
      after.motions.size() < before.motions.size() || after.loops.size() < before.loops.size();
  return is_shorter ? Need::kShortened : Need::kWhole;
}

CloudSlice SliceNeeds::shortened(const PlacedSlice& correction) const {
  CloudSlice slice = whole(correction);
  shorten(slice);
  return slice;
}

std::size_t SliceNeeds::max_chunk_bytes(const PlacedSlice& slice) {
  std::size_t bytes = kMinMaxChunkBytes;
  for (const auto& chunk : slice.chunks) {
    bytes = std::max(bytes, static_cast<std::size_t>(chunk->place.size));
  }
  return bytes;
}

CloudSlice SliceNeeds::whole(const PlacedSlice& slice) const {
  std::vector<Chunk<CloudSlice>> chunks;
  chunks.reserve(slice.chunks.size());
  for (const auto& chunk : slice.chunks) {
    chunks.push_back(decode_chunk<CloudSlice>(read_(chunk->place)));
  }
  return join(chunks);
}

void SliceNeeds::shorten(CloudSlice& correction) const {
  std::erase_if(correction.motions, [&](const PatchMotion& motion) {
    return placed_by_.at(motion.id) != correction.correction;
  });
  if (last_with_loops_of_.at(correction.part) != correction.correction) correction.loops.clear();
}

}  // namespace kintsugi::mapper
