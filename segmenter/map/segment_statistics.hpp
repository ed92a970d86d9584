#pragma once
// Statistics of each segment, updated as points change segment.

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/block_extents.hpp"
#include "segmenter/map/extent.hpp"
#include "segmenter/map/last_change.hpp"
#include "segmenter/map/segment_sums.hpp"

namespace kintsugi::segmenter {

/// The statistics of every segment (SegmentSums), and the slice with which it last changed. They
/// are to the bit what summing from scratch would give.
class SegmentStatisticsTable {
 public:
  /// @param resolution_m voxel size, > 0: a point stands for resolution_m^2 of surface
  explicit SegmentStatisticsTable(float resolution_m) : resolution_m_(resolution_m) {}

  /// Applies `changes`, after which `cloud` and `ids` are as given. Returns the ids of the segments
  /// that changed and still have points, ascending; `now` becomes their last change. Takes time
  /// proportional to the changes, plus a small part of its points for each segment that lost a
  /// point on a face of its box.
  std::vector<std::uint32_t> apply(const PointCloud& cloud, const SegmentIds& ids,
                                   std::span<const IdChange> changes, const LastChange& now = {});

  /// As apply(), after a change with points that moved in place. Their segments change, too. Takes
  /// time proportional to the size of the map.
  std::vector<std::uint32_t> recount(const PointCloud& cloud, const SegmentIds& ids,
                                     std::span<const IdChange> changes,
                                     std::span<const PointRange> moved_in_place,
                                     const LastChange& now = {});

  /// The statistics of a segment that has points.
  [[nodiscard]] SegmentStatistics operator()(std::uint32_t segment_id) const;
  [[nodiscard]] LastChange last_change(std::uint32_t segment_id) const;

  /// Of all segments that have points, by ascending id.
  [[nodiscard]] std::vector<SegmentStatistics> all() const;
  [[nodiscard]] std::vector<LastChange> last_changes() const;

  /// Sets what last_changes() returned for the same segments.
  /// @throws std::invalid_argument unless there is one for each segment
  void set_last_changes(std::span<const LastChange> last_changes);

  /// What is not used for long may go to disk from now on.
  void swap_to(SwapSpace& space) {
    place_.swap_to(space);
    sums_.swap_to(space);
  }
  /// Memory in use.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Sums : SegmentSums {
    bool extent_is_stale = false;  ///< a point on its border has left
    LastChange last_change;
  };
  /// A segment and a block of PointIndices (BlockExtents) in which it gained or lost points.
  struct Touched {
    std::uint32_t segment_id;
    std::uint32_t block;

    bool operator==(const Touched&) const = default;
    bool operator<(const Touched& other) const {
      return std::tie(segment_id, block) < std::tie(other.segment_id, other.block);
    }
  };

  Sums& sums_of(std::uint32_t segment_id);
  std::vector<Touched> add_up(const PointCloud& cloud, std::span<const IdChange> changes);
  [[nodiscard]] std::vector<Touched> count_anew(const PointCloud& cloud, const SegmentIds& ids,
                                                std::span<const std::uint8_t> is_counted);
  void scan_blocks(const PointCloud& cloud, const SegmentIds& ids, std::span<const Touched> places);
  void refresh_extent(const PointCloud& cloud, const SegmentIds& ids, std::uint32_t segment_id,
                      std::span<const std::uint32_t> blocks);
  void remove(std::uint32_t segment_id);

  /// A segment of more points than this keeps its extent by blocks, because a scan of all its
  /// points whenever one leaves a face of its box takes too long. Below half as many it stops doing
  /// so.
  static constexpr std::int64_t kLargePoints = 1024;

  float resolution_m_;
  GrowingArray<std::uint32_t> place_;               ///< in sums_, by segment id
  GrowingArray<Sums> sums_{1};                      ///< place 0: for all ids without points
  std::vector<std::uint32_t> free_places_;          ///< in sums_
  std::map<std::uint32_t, BlockExtents> by_block_;  ///< of large segments, by id
};

}  // namespace kintsugi::segmenter
