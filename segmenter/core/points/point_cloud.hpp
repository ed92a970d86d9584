#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/core/points/free_ranges.hpp"

namespace kintsugi::segmenter {

/// Where a point stands in the cloud. It names the point only as long as the point does not move:
/// places of points that are gone are used again.
using PointIndex = std::uint32_t;

/// The persistent id of a point: it stays when the map is corrected, saved, resumed or replayed.
struct PointId {
  std::int32_t slice_id = 0;
  std::int32_t index = 0;  ///< in the slice as it was received, rejected points included

  bool operator==(const PointId&) const = default;
  bool operator<(const PointId& other) const {
    return std::tie(slice_id, index) < std::tie(other.slice_id, other.index);
  }
};

/// A point that was there before and has another place now: its PointId stays.
struct MovedPoint {
  PointIndex from = 0;
  PointIndex to = 0;

  bool operator==(const MovedPoint&) const = default;
};

/// The points that came and went between two updates of an engine. A point that moved is one of
/// each: its new place has an index of its own.
struct CloudChange {
  std::vector<PointIndex> added;    ///< ascending
  std::vector<PointIndex> removed;  ///< ascending; readable until the cloud is changed again
  std::vector<MovedPoint> moved;    ///< removed and added points of one PointId, by ascending `to`
};

/// What became of one slice: its accepted points are `[first, first + count)` of the cloud.
struct SliceRecord {
  std::int32_t slice_id = 0;
  std::int32_t revision = 0;
  std::int32_t num_points = 0;         ///< as received
  PointIndex first = 0;                ///< of its accepted points
  PointIndex count = 0;                ///< accepted points
  std::vector<std::int32_t> rejected;  ///< ascending indices in the slice of those left out

  /// The index in the slice of its accepted point number `k` < count.
  std::int32_t index_of(PointIndex k) const;
};

/// All points of the map that can be segmented, by slice, frame W.
///
/// A point that reason_to_reject() (admission.hpp) names one for, for instance one that is not
/// finite, is recorded in its slice and never gets a PointIndex.
///
/// A slice that comes again gets new places. Its old ones stay readable after take_change() until
/// the cloud is changed again; then slices that come later may use them, so that corrections do not
/// make the cloud grow for ever.
class PointCloud {
 public:
  /// Adds the points of a slice and returns its record (valid until the next change).
  /// Throws std::invalid_argument, and changes nothing, when `slice_id` is negative or already
  /// present; std::length_error when the cloud would outgrow PointIndex.
  const SliceRecord& add_slice(std::int32_t slice_id, std::span<const CloudPoint> points_W,
                               std::int32_t revision = 0);

  /// Takes `points_W` for the points the slice had: point k of them is point k of before, moved.
  /// `revision` is by default one more than before. Throws as add_slice(); std::invalid_argument
  /// also when there is no such slice or `revision` is not above the one before.
  const SliceRecord& replace_slice(std::int32_t slice_id, std::span<const CloudPoint> points_W,
                                   std::optional<std::int32_t> revision = std::nullopt);

  /// Takes the slice and its points away. Throws std::invalid_argument when there is no such slice.
  void remove_slice(std::int32_t slice_id);

  /// What has come and gone since the last call.
  CloudChange take_change();

  /// All points as if they had just come.
  CloudChange everything() const;

  /// One past the largest index in use so far; not all below it are live.
  PointIndex size() const { return static_cast<PointIndex>(points_W_.size()); }
  /// Points in the cloud.
  PointIndex num_live() const { return num_live_; }
  bool is_live(PointIndex i) const { return find_live(i) != nullptr; }
  /// A live point, or one removed by the change taken last.
  const CloudPoint& operator[](PointIndex i) const { return points_W_[i]; }
  /// By index, gone ones among them.
  std::span<const CloudPoint> points_W() const { return points_W_.span(); }

  /// In order of arrival of their first revision.
  std::span<const SliceRecord> slices() const { return slices_; }
  /// The slice called `slice_id`, nullptr when there is none.
  const SliceRecord* find_slice(std::int32_t slice_id) const;
  /// The slice that point `i` came with: a live point, or one removed by the change taken last (or
  /// to be taken), for which it is the record that the slice had before.
  const SliceRecord& slice_of(PointIndex i) const;
  PointId id_of(PointIndex i) const;
  std::int64_t num_rejected() const { return num_rejected_; }
  /// Memory of the points.
  std::size_t bytes() const { return points_W_.bytes(); }

 private:
  /// Where the accepted points of slices_[slice] begin.
  struct Range {
    PointIndex first;
    std::uint32_t slice;
  };
  struct Retired {
    SliceRecord record;
    bool was_told;  ///< by a change taken before
  };

  std::uint32_t position_of(std::int32_t slice_id) const;
  const SliceRecord* find_live(PointIndex i) const;
  void begin_change();
  SliceRecord place(std::int32_t slice_id, std::int32_t revision,
                    std::span<const CloudPoint> points_W);
  void make_live(std::uint32_t slice, SliceRecord record);
  void retire(std::uint32_t slice);

  GrowingArray<CloudPoint> points_W_;
  std::vector<SliceRecord> slices_;
  std::map<std::int32_t, std::uint32_t> position_;  ///< in slices_, by slice id
  std::vector<Range> ranges_;                       ///< of slices that have points, ascending
  FreeRanges free_;
  PointIndex num_live_ = 0;
  std::int64_t num_rejected_ = 0;

  std::set<std::int32_t> untold_;  ///< slices that came since the change was last taken
  std::vector<Retired> retired_;   ///< what went since then, or by the change taken last; by first
  bool is_taken_ = false;          ///< the change that retired_ tells of
};

/// slice_of() for many points, quick where neighbours follow one another. Valid while the cloud
/// does not change.
class SliceFinder {
 public:
  explicit SliceFinder(const PointCloud& cloud) : cloud_(cloud) {}

  const SliceRecord& operator()(PointIndex point) {
    if (slice_ == nullptr || point - slice_->first >= slice_->count) {
      slice_ = &cloud_.slice_of(point);
    }
    return *slice_;
  }

 private:
  const PointCloud& cloud_;
  const SliceRecord* slice_ = nullptr;
};

}  // namespace kintsugi::segmenter
