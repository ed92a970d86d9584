#include "segmenter/evaluation/live/region_labels.hpp"

#include <algorithm>

namespace kintsugi::segmenter {
namespace {

using Count = std::pair<std::uint32_t, std::int32_t>;

/// The label that a region has now, given the one that it had.
std::uint32_t label_of(const Region& region) {
  const auto most = std::ranges::max_element(region.counts, [](const Count& a, const Count& b) {
    return std::pair(a.second, b.first) < std::pair(b.second, a.first);
  });
  if (most == region.counts.end()) return region.label;  // empty for a moment: it keeps its label
  const auto own = std::ranges::find(region.counts, region.label, &Count::first);
  const std::int32_t num_own = own == region.counts.end() ? 0 : own->second;
  return most->second > 2 * num_own ? most->first : region.label;
}

}  // namespace

std::uint32_t Heirs::last_heir(std::uint32_t id) const {
  // An id that is gone never comes back; in a log of two segmenters it might.
  for (std::size_t i = 0; i < heir_.size(); ++i) {
    const auto heir = heir_.find(id);
    if (heir == heir_.end()) break;
    id = heir->second;
  }
  return id;
}

std::int32_t Region::num_points() const {
  std::int32_t sum = 0;
  for (const auto& [id, count] : counts) sum += count;
  return sum;
}

Region& RegionLabels::touch(const Eigen::Vector3d& p_W) {
  const CellKey key = cell_at(p_W, cell_m_);
  Region& region = regions_[key];
  if (!region.is_touched) touched_.push_back(key);
  region.is_touched = true;
  return region;
}

void RegionLabels::add_point(const Eigen::Vector3d& p_W, std::uint32_t segment_id, double now_s) {
  Region& region = touch(p_W);
  if (region.first_label_s < 0.0) region.first_label_s = now_s;
  const auto count = std::ranges::find(region.counts, segment_id, &Count::first);
  if (count == region.counts.end()) {
    region.counts.emplace_back(segment_id, 1);
  } else {
    ++count->second;
  }
}

void RegionLabels::remove_point(const Eigen::Vector3d& p_W, std::uint32_t segment_id) {
  Region& region = touch(p_W);
  const auto count = std::ranges::find(region.counts, segment_id, &Count::first);
  if (count != region.counts.end() && --count->second == 0) region.counts.erase(count);
}

void RegionLabels::settle(double now_s, const Heirs& heirs) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> handovers;
  for (const CellKey key : touched_) {
    Region& region = regions_[key];
    region.is_touched = false;
    const std::uint32_t before = region.label;
    region.label = label_of(region);
    const bool is_newborn = before == 0 || now_s - region.first_label_s <= kNewborn_s;
    if (is_newborn || region.label == before) continue;
    ++region.num_changes;
    handovers.emplace(before, region.label);
    num_by_merge_ += heirs.last_heir(before) == heirs.last_heir(region.label) ? 1 : 0;
  }
  touched_.clear();
  num_handovers_ += static_cast<std::int64_t>(handovers.size());
}

}  // namespace kintsugi::segmenter
