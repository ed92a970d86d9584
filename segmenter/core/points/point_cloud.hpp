#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "segmenter/core/points/free_ranges.hpp"

namespace kintsugi::segmenter {

/// The position of a point in the cloud's arrays. A point that moves gets another one, and those of
/// points that are gone are used again.
using PointIndex = std::uint32_t;

/// The persistent id of a point. It stays the same when the map is corrected, saved and resumed, or
/// built again from a log.
struct PointId {
  std::int32_t slice_id = 0;
  std::int32_t index = 0;  ///< in the slice as received, counting rejected points

  bool operator==(const PointId&) const = default;
  bool operator<(const PointId& other) const {
    return std::tie(slice_id, index) < std::tie(other.slice_id, other.index);
  }
};

/// A point that has another PointIndex than before. Its PointId stays the same, except in a patch.
struct MovedPoint {
  PointIndex from = 0;
  PointIndex to = 0;

  bool operator==(const MovedPoint&) const = default;
};

/// The points [first, first + count).
struct PointRange {
  PointIndex first = 0;
  PointIndex count = 0;

  bool operator==(const PointRange&) const = default;
};

/// The points that came and went between two updates of an engine. A point that moved is in both
/// lists, with its old and its new index, unless it moved in place.
struct CloudChange {
  std::vector<PointIndex> added;    ///< ascending
  std::vector<PointIndex> removed;  ///< ascending; still readable until the cloud changes again
  std::vector<MovedPoint> moved;    ///< removed and added points that are the same, by `to`
  /// Points that have other positions and normals at the same index (move_in_place()), ascending.
  /// Where there are some, nothing is known any more that was computed from positions, not even of
  /// the points in `removed`.
  std::vector<PointRange> moved_in_place;
};

/// Whether a slice is a patch, and whether that may still change.
enum class PatchState : std::uint8_t {
  kNoPatch = 0,
  kInVolume = 1,  ///< in the mapper's volume
  kLeft = 2,      ///< its last revision, as far as is known
};

/// That of a slice as received.
inline PatchState patch_state_of(const CloudSlice& slice) {
  if (slice.kind != SliceKind::kPatch) return PatchState::kNoPatch;
  return slice.in_volume ? PatchState::kInVolume : PatchState::kLeft;
}

/// Points that are kept as received, in the frame P of their patch. They never change: copies of a
/// cloud's records share them.
using PointsInPatch = std::shared_ptr<const std::vector<CloudPoint>>;

/// A slice in the cloud. Its accepted points are `[first, first + count)`.
struct SliceRecord {
  std::int32_t slice_id = 0;
  std::int32_t revision = 0;
  PatchState patch = PatchState::kNoPatch;
  std::int32_t num_points = 0;           ///< as received
  PointIndex first = 0;                  ///< of its accepted points
  PointIndex count = 0;                  ///< accepted points
  std::vector<std::int32_t> rejected{};  ///< indices in the slice of rejected points, ascending
  PatchPlace place;                      ///< of a patch: where P is
  PointsInPatch points_P{};              ///< the accepted points; null where P is W

  bool is_in_volume() const { return patch == PatchState::kInVolume; }
  /// The index in the slice of its accepted point number `k` < count.
  std::int32_t index_of(PointIndex k) const;
};

/// All points of the map that can be segmented, by slice, frame W.
///
/// A point that reason_to_reject() (admission.hpp) rejects, for instance one that is not finite, is
/// recorded in its slice and never gets a PointIndex. It is rejected as it was received: a motion
/// of its patch changes nothing about that.
///
/// A slice that is replaced gets new indices. Its old points stay readable after take_change()
/// until the cloud changes again. Later slices then use their indices, so that corrections do not
/// make the cloud grow without limit. Which new point is which old one: in a slice that is
/// corrected, the one with the same index in the slice; in a patch, the one in the same voxel of P
/// (pair_by_voxel()), since its points come in other places of the list.
///
/// A patch that moves gets new indices in the same way, in the same revision. Its points are moved
/// from where they were received, so that they do not depend on earlier motions. Where a large part
/// of the map moves, patches can move in place: then points keep their indices.
class PointCloud {
 public:
  /// @param voxel_m voxel size, for patches; 0: their points are paired as those of other slices
  explicit PointCloud(double voxel_m = 0.0) : voxel_m_(voxel_m) {}

  /// Adds the points of a slice, which is at `place`, and returns its record, which is valid until
  /// the next change. For all slices but patches P is W.
  /// @throws std::invalid_argument when `slice_id` is negative or already present,
  ///   std::length_error when the cloud would outgrow PointIndex; then nothing has changed
  const SliceRecord& add_slice(std::int32_t slice_id, std::span<const CloudPoint> points_P,
                               std::int32_t revision = 0, PatchState patch = PatchState::kNoPatch,
                               const PatchPlace& place = {});

  /// Replaces the points of a slice. There may be fewer points, or none. `revision` is one more
  /// than before by default.
  /// @throws as add_slice(); std::invalid_argument also when there is no such slice, or `revision`
  ///   is not above the old one
  const SliceRecord& replace_slice(std::int32_t slice_id, std::span<const CloudPoint> points_P,
                                   std::optional<std::int32_t> revision = std::nullopt,
                                   PatchState patch = PatchState::kNoPatch,
                                   const PatchPlace& place = {});

  /// Moves a slice to `place`.
  /// @throws as replace_slice()
  const SliceRecord& move_slice(std::int32_t slice_id, const PatchPlace& place);

  /// Moves patches, each of which is named once, and their points keep their indices. Only for
  /// engines that take such changes (SegmentationEngine::takes_moves_in_place()).
  /// @throws std::invalid_argument, and moves nothing, when there is no such slice
  void move_in_place(std::span<const PlacedPatch> patches);

  /// What changed since the last call.
  CloudChange take_change();

  /// All points, as if all had just come.
  CloudChange everything() const;

  /// One past the largest index used so far. Not all indices below it are live.
  PointIndex size() const { return static_cast<PointIndex>(points_W_.size()); }
  /// Points in the cloud.
  PointIndex num_live() const { return num_live_; }
  bool is_live(PointIndex i) const { return find_live(i) != nullptr; }
  /// A live point, or one removed by the change taken last.
  const CloudPoint& operator[](PointIndex i) const { return points_W_[i]; }
  /// By index, including points that are gone.
  std::span<const CloudPoint> points_W() const { return points_W_.span(); }

  /// In order of arrival of their first revision.
  std::span<const SliceRecord> slices() const { return slices_; }
  /// nullptr when there is no such slice.
  const SliceRecord* find_slice(std::int32_t slice_id) const;
  /// The slice of point `i`, which is live, or was removed by the change taken last or not yet
  /// taken. For a removed point this is the record from before.
  const SliceRecord& slice_of(PointIndex i) const;
  PointId id_of(PointIndex i) const;
  std::int64_t num_rejected() const { return num_rejected_; }
  /// The points may go to disk from now on.
  void swap_to(SwapSpace& space) { points_W_.swap_to(space); }
  /// Memory of the points.
  std::size_t bytes() const { return points_W_.bytes() + bytes_P_; }

 private:
  /// Where the accepted points of slices_[slice] begin.
  struct Range {
    PointIndex first;
    std::uint32_t slice;
  };
  struct Retired {
    SliceRecord record;
    bool was_reported;  ///< as added, by a change taken before
  };

  std::uint32_t position_of(std::int32_t slice_id) const;
  const SliceRecord* find_live(PointIndex i) const;
  void begin_change();
  SliceRecord store(SliceRecord slice, std::span<const CloudPoint> points_P);
  void place(SliceRecord& slice, PointsInPatch accepted_P);
  void put_in_place(SliceRecord& slice, const PatchPlace& place);
  void check_size(std::int32_t slice_id, std::size_t num_points) const;
  [[nodiscard]] std::span<const CloudPoint> points_P(const SliceRecord& slice) const;
  void append_moved(const SliceRecord& before, const SliceRecord& after,
                    std::vector<MovedPoint>& moved) const;
  void make_live(std::uint32_t slice, SliceRecord record);
  void retire(std::uint32_t slice);

  double voxel_m_;
  GrowingArray<CloudPoint> points_W_;
  std::size_t bytes_P_ = 0;  ///< of the points that are kept in P, too
  std::vector<SliceRecord> slices_;
  std::map<std::int32_t, std::uint32_t> position_;  ///< in slices_, by slice id
  std::vector<Range> ranges_;                       ///< of slices that have points, ascending
  FreeRanges free_;
  PointIndex num_live_ = 0;
  std::int64_t num_rejected_ = 0;

  std::set<std::int32_t> unreported_;      ///< slices that came since the last take_change()
  std::set<std::int32_t> moved_in_place_;  ///< since the last take_change()
  std::vector<Retired> retired_;           ///< old records of replaced slices, by `first`
  bool is_taken_ = false;                  ///< retired_ has been returned by take_change()
};

/// PointCloud::slice_of() for many points; fast where consecutive points are of one slice. Valid
/// while the cloud does not change.
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
