#include "segmenter/map/segment_statistics.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

namespace kintsugi::segmenter {

std::vector<std::uint32_t> SegmentStatisticsTable::apply(const PointCloud& cloud,
                                                         const SegmentIds& ids,
                                                         std::span<const IdChange> changes,
                                                         const LastChange& now) {
  place_.resize(ids.next_id());
  const std::vector<Touched> touched = add_up(cloud, changes);
  std::vector<std::uint32_t> changed_ids;
  std::vector<std::uint32_t> blocks;
  for (auto first = touched.begin(); first != touched.end();) {
    const std::uint32_t id = first->segment_id;
    blocks.clear();
    for (; first != touched.end() && first->segment_id == id; ++first) {
      blocks.push_back(first->block);
    }
    if (sums_of(id).num_points == 0) {
      remove(id);
    } else {
      refresh_extent(cloud, ids, id, blocks);
      sums_of(id).last_change = now;
      changed_ids.push_back(id);
    }
  }
  return changed_ids;
}

/// Updates the sums. Returns the segments and blocks that were touched, ascending, each once.
std::vector<SegmentStatisticsTable::Touched> SegmentStatisticsTable::add_up(
    const PointCloud& cloud, std::span<const IdChange> changes) {
  std::vector<Touched> touched;
  const auto touch = [&](std::uint32_t segment_id, PointIndex point) {
    const Touched now{segment_id, point / BlockExtents::kBlockPoints};
    if (touched.empty() || touched.back() != now) touched.push_back(now);
  };
  SliceFinder slice_of(cloud);
  for (const IdChange& change : changes) {
    const CloudPoint& point = cloud[change.point];
    const SliceRecord& slice = slice_of(change.point);
    const std::int32_t slice_id = slice.slice_id;
    if (change.old_id != kNoSegment) {
      Sums& old = sums_of(change.old_id);
      old.add(point, slice.is_in_volume(), -1);
      old.extent_is_stale = old.extent_is_stale || old.extent.touches(point, slice_id);
      touch(change.old_id, change.point);
    }
    if (change.new_id != kNoSegment) {
      Sums& heir = sums_of(change.new_id);
      heir.add(point, slice.is_in_volume(), 1);
      heir.extent.include(point, slice_id);
      touch(change.new_id, change.point);
    }
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

/// `blocks` are those in which the segment gained or lost points.
void SegmentStatisticsTable::refresh_extent(const PointCloud& cloud, const SegmentIds& ids,
                                            std::uint32_t segment_id,
                                            std::span<const std::uint32_t> blocks) {
  Sums& sums = sums_of(segment_id);
  auto by_block = by_block_.find(segment_id);
  std::vector<std::uint32_t> all_blocks;
  if (by_block == by_block_.end() && sums.num_points > kLargePoints) {
    by_block = by_block_.try_emplace(segment_id).first;
    for (const PointIndex point : ids.points_of(segment_id)) {
      all_blocks.push_back(point / BlockExtents::kBlockPoints);
    }
    std::sort(all_blocks.begin(), all_blocks.end());
    all_blocks.erase(std::unique(all_blocks.begin(), all_blocks.end()), all_blocks.end());
    blocks = all_blocks;
  } else if (by_block != by_block_.end() && 2 * sums.num_points < kLargePoints) {
    by_block_.erase(by_block);
    by_block = by_block_.end();
  }
  const bool is_large = by_block != by_block_.end();
  if (is_large) by_block->second.refresh(blocks, cloud, ids.ids(), segment_id);
  if (!sums.extent_is_stale) return;

  sums.extent_is_stale = false;
  if (is_large) {
    sums.extent = by_block->second.combined();
  } else {
    sums.extent = {};
    SliceFinder slice_of(cloud);
    for (const PointIndex point : ids.points_of(segment_id)) {
      sums.extent.include(cloud[point], slice_of(point).slice_id);
    }
  }
}

SegmentStatisticsTable::Sums& SegmentStatisticsTable::sums_of(std::uint32_t segment_id) {
  std::uint32_t& place = place_[segment_id];
  if (place == 0 && !free_places_.empty()) {
    place = free_places_.back();
    free_places_.pop_back();
    sums_[place] = {};
  } else if (place == 0) {
    place = static_cast<std::uint32_t>(sums_.size());
    sums_.push_back({});
  }
  return sums_[place];
}

void SegmentStatisticsTable::remove(std::uint32_t segment_id) {
  free_places_.push_back(std::exchange(place_[segment_id], 0));
  by_block_.erase(segment_id);
}

SegmentStatistics SegmentStatisticsTable::operator()(std::uint32_t segment_id) const {
  return sums_[place_[segment_id]].statistics(segment_id, resolution_m_);
}

LastChange SegmentStatisticsTable::last_change(std::uint32_t segment_id) const {
  return sums_[place_[segment_id]].last_change;
}

std::vector<SegmentStatistics> SegmentStatisticsTable::all() const {
  std::vector<SegmentStatistics> result;
  for (std::size_t id = 0; id < place_.size(); ++id) {
    if (place_[id] != 0) {
      result.push_back((*this)(static_cast<std::uint32_t>(id)));
    }
  }
  return result;
}

std::vector<LastChange> SegmentStatisticsTable::last_changes() const {
  std::vector<LastChange> result;
  result.reserve(sums_.size());
  for (const std::uint32_t place : place_) {
    if (place != 0) result.push_back(sums_[place].last_change);
  }
  return result;
}

void SegmentStatisticsTable::set_last_changes(std::span<const LastChange> last_changes) {
  const auto num_segments =
      std::count_if(place_.begin(), place_.end(), [](std::uint32_t place) { return place != 0; });
  if (std::ssize(last_changes) != num_segments) {
    throw std::invalid_argument(std::to_string(num_segments) + " segments, but " +
                                std::to_string(last_changes.size()) + " last changes");
  }
  auto next = last_changes.begin();
  for (const std::uint32_t place : place_) {
    if (place != 0) sums_[place].last_change = *next++;
  }
}

std::size_t SegmentStatisticsTable::bytes() const {
  std::size_t bytes =
      place_.bytes() + sums_.bytes() + free_places_.capacity() * sizeof(free_places_[0]);
  for (const auto& [id, blocks] : by_block_) bytes += blocks.bytes() + sizeof(blocks) + 48;
  return bytes;
}

}  // namespace kintsugi::segmenter
