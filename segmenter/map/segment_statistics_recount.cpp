// The statistics of segments whose points have moved in place.

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <utility>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/map/segment_statistics.hpp"

namespace kintsugi::segmenter {

std::vector<std::uint32_t> SegmentStatisticsTable::recount(
    const PointCloud& cloud, const SegmentIds& ids, std::span<const IdChange> changes,
    std::span<const PointRange> moved_in_place, const LastChange& now) {
  place_.resize(ids.next_id());
  std::vector<std::uint8_t> is_counted(ids.next_id());
  for (const PointRange& range : moved_in_place) {
    for (const std::uint32_t id : ids.ids().subspan(range.first, range.count)) is_counted[id] = 1;
  }
  for (const IdChange& change : changes) is_counted[change.old_id] = is_counted[change.new_id] = 1;
  is_counted[kNoSegment] = 0;

  const std::vector<Touched> places = count_anew(cloud, ids, is_counted);
  std::vector<std::uint32_t> changed_ids;
  for (std::uint32_t id = 0; id < is_counted.size(); ++id) {
    if (is_counted[id] == 0) continue;
    by_block_.erase(id);
    if (ids.num_points_of(id) > 0) {
      sums_of(id).last_change = now;
      changed_ids.push_back(id);
    } else if (place_[id] != 0) {
      remove(id);
    }
  }
  scan_blocks(cloud, ids, places);
  return changed_ids;
}

/// Sums up the points of the segments that are to be counted. Returns the blocks in which they have
/// points, ascending, each once.
std::vector<SegmentStatisticsTable::Touched> SegmentStatisticsTable::count_anew(
    const PointCloud& cloud, const SegmentIds& ids, std::span<const std::uint8_t> is_counted) {
  struct Counts {
    std::unordered_map<std::uint32_t, SegmentSums> sums;
    std::vector<Touched> places;
  };
  oneapi::tbb::enumerable_thread_specific<Counts> by_thread;
  oneapi::tbb::parallel_for(std::size_t{0}, cloud.slices().size(), [&](std::size_t s) {
    const SliceRecord& slice = cloud.slices()[s];
    Counts& counts = by_thread.local();
    SegmentSums* sums = nullptr;
    Touched last{kNoSegment, 0};
    for (PointIndex p = slice.first; p < slice.first + slice.count; ++p) {
      const Touched place{ids.ids()[p], p / BlockExtents::kBlockPoints};
      if (is_counted[place.segment_id] == 0) continue;
      if (place.segment_id != last.segment_id) sums = &counts.sums[place.segment_id];
      if (place != last) counts.places.push_back(place);
      last = place;
      sums->add(cloud[p], slice.is_in_volume(), 1);
      sums->extent.include(cloud[p], slice.slice_id);
    }
  });

  for (std::uint32_t id = 0; id < is_counted.size(); ++id) {
    if (is_counted[id] != 0 && (place_[id] != 0 || ids.num_points_of(id) > 0)) sums_of(id) = {};
  }
  // Sums of integers, least and largest values: the order of the threads does not matter.
  std::vector<Touched> places;
  for (const Counts& counts : by_thread) {
    for (const auto& [id, sums] : counts.sums) sums_of(id).add(sums);
    places.insert(places.end(), counts.places.begin(), counts.places.end());
  }
  std::erase_if(places, [&](const Touched& place) {
    return sums_of(place.segment_id).num_points <= kLargePoints;
  });
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

/// Finds the extents of large segments in the blocks given. Their old ones must be gone.
void SegmentStatisticsTable::scan_blocks(const PointCloud& cloud, const SegmentIds& ids,
                                         std::span<const Touched> places) {
  struct Scan {
    std::uint32_t segment_id;
    BlockExtents* extents;
    std::vector<std::uint32_t> blocks;
  };
  std::vector<Scan> scans;
  for (const Touched& place : places) {
    if (scans.empty() || scans.back().segment_id != place.segment_id) {
      scans.push_back({place.segment_id, &by_block_[place.segment_id], {}});
    }
    scans.back().blocks.push_back(place.block);
  }
  oneapi::tbb::parallel_for(std::size_t{0}, scans.size(), [&](std::size_t k) {
    scans[k].extents->refresh(scans[k].blocks, cloud, ids.ids(), scans[k].segment_id);
  });
}

}  // namespace kintsugi::segmenter
