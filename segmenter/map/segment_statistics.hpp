#pragma once
// What is known about each segment, kept up to date as points change segment.

#include <array>
#include <cstdint>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/point_cloud.hpp"
#include "segmenter/core/segment_ids.hpp"

namespace kintsugi::segmenter {

/// Statistics of every segment.
///
/// Sums are integers in fixed point (units of 2^-40), so that adding and removing points in any
/// order gives the very result of summing from scratch. A coordinate of more than 15 micrometres,
/// a float32, is exact in these units.
class SegmentStatisticsTable {
 public:
  /// @param resolution_m voxel size, > 0: a point stands for resolution_m^2 of surface
  explicit SegmentStatisticsTable(float resolution_m) : resolution_m_(resolution_m) {}

  /// Takes over `changes`; `cloud` and `ids` are those after them. Returns the ids of the segments
  /// that changed and still have points, ascending. Costs time in proportion to the changes, and to
  /// the size of the segments that lost a point on the face of their box.
  std::vector<std::uint32_t> apply(const PointCloud& cloud, const SegmentIds& ids,
                                   const std::vector<IdChange>& changes);

  /// Of a segment that has points.
  [[nodiscard]] SegmentStatistics operator()(std::uint32_t segment_id) const;

  /// Of every segment that has points, by ascending id.
  [[nodiscard]] std::vector<SegmentStatistics> all() const;

 private:
  struct Extent {
    std::array<float, 3> min_W;
    std::array<float, 3> max_W;
    std::int32_t first_slice;
    std::int32_t last_slice;

    static Extent none();
    void include(const CloudPoint& point, std::int32_t slice_id);
    [[nodiscard]] bool touches(const CloudPoint& point, std::int32_t slice_id) const;
  };
  __extension__ using WideInteger = __int128;  // 2^60 for each coordinate, and room for 2^67 points
  struct Sums {
    std::int64_t num_points = 0;
    std::array<WideInteger, 3> position{};
    std::array<WideInteger, 3> normal{};
    std::array<std::int64_t, 3> color{};
    Extent extent = Extent::none();
    bool extent_is_stale = false;  ///< a point that touched it has left

    void add(const CloudPoint& point, std::int64_t sign);
  };

  void rebuild_extent(const PointCloud& cloud, const SegmentIds& ids, std::uint32_t segment_id);

  float resolution_m_;
  std::vector<Sums> sums_;  // by segment id
};

}  // namespace kintsugi::segmenter
