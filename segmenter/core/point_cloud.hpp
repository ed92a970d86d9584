#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/growing_array.hpp"

namespace kintsugi::segmenter {

/// Position of a point in the map, in order of arrival.
using PointIndex = std::uint32_t;

/// The persistent id of a point: it stays when the map is saved, resumed or replayed.
struct PointId {
  std::int32_t slice_id = 0;
  std::int32_t index = 0;  ///< in the slice as it was received, rejected points included

  bool operator==(const PointId&) const = default;
};

/// The points that came and went between two updates of an engine. A point that moved is one of
/// each: its new place has an index of its own.
struct CloudChange {
  std::vector<PointIndex> added;    ///< ascending
  std::vector<PointIndex> removed;  ///< ascending; readable until the cloud is changed again
};

/// What became of one slice: its accepted points are `[first, first + count)` of the cloud.
struct SliceRecord {
  std::int32_t slice_id = 0;
  std::int32_t num_points = 0;         ///< as received
  PointIndex first = 0;                ///< of its accepted points
  PointIndex count = 0;                ///< accepted points
  std::vector<std::int32_t> rejected;  ///< ascending indices in the slice of those left out
};

/// All points of the map that can be segmented, slice after slice, frame W.
///
/// A point that reason_to_reject() (admission.hpp) names one for, for instance one that is not
/// finite, is recorded in its slice and never gets a PointIndex.
class PointCloud {
 public:
  /// Appends the points of a slice and returns its record (valid until the next call).
  /// Throws std::invalid_argument, and changes nothing, when `slice_id` is negative or already
  /// present; std::length_error when the cloud would outgrow PointIndex.
  const SliceRecord& add_slice(std::int32_t slice_id, std::span<const CloudPoint> points_W);

  /// What has come and gone since the last call.
  CloudChange take_change() { return std::exchange(change_, {}); }

  /// All points as if they had just come.
  CloudChange everything() const;

  PointIndex size() const { return static_cast<PointIndex>(points_W_.size()); }
  const CloudPoint& operator[](PointIndex i) const { return points_W_[i]; }
  std::span<const CloudPoint> points_W() const { return points_W_.span(); }

  /// In order of arrival.
  std::span<const SliceRecord> slices() const { return slices_; }
  /// The slice that point `i` came with; `i` < size().
  const SliceRecord& slice_of(PointIndex i) const;
  PointId id_of(PointIndex i) const;
  std::int64_t num_rejected() const { return num_rejected_; }

 private:
  GrowingArray<CloudPoint> points_W_;
  std::vector<SliceRecord> slices_;
  CloudChange change_;
  std::int64_t num_rejected_ = 0;
};

}  // namespace kintsugi::segmenter
