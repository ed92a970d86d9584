#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Position of a point in the map, in order of arrival.
using PointIndex = std::uint32_t;

/// The persistent id of a point: it stays when the map is saved, resumed or replayed.
struct PointId {
  std::int32_t slice_id = 0;
  std::int32_t index = 0;  ///< in the slice as it was received, rejected points included

  bool operator==(const PointId&) const = default;
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

  PointIndex size() const { return static_cast<PointIndex>(points_W_.size()); }
  const CloudPoint& operator[](PointIndex i) const { return points_W_[i]; }
  std::span<const CloudPoint> points_W() const { return points_W_; }

  /// In order of arrival.
  std::span<const SliceRecord> slices() const { return slices_; }
  /// The slice that point `i` came with; `i` < size().
  const SliceRecord& slice_of(PointIndex i) const;
  PointId id_of(PointIndex i) const;
  std::int64_t num_rejected() const { return num_rejected_; }

 private:
  std::vector<CloudPoint> points_W_;
  std::vector<SliceRecord> slices_;
  std::int64_t num_rejected_ = 0;
};

}  // namespace kintsugi::segmenter
