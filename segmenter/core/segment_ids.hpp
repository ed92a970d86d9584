#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/point_cloud.hpp"

namespace kintsugi::segmenter {

struct Overlap;

/// A point that carries another segment id than before.
struct IdChange {
  PointIndex point = 0;
  std::uint32_t old_id = kNoSegment;  ///< kNoSegment for a new point
  std::uint32_t new_id = kNoSegment;

  bool operator==(const IdChange&) const = default;
};

/// What one update of the partition means in terms of persistent ids.
///
/// Every birth and every death of an id is told by exactly one event:
///   kCreated  a new id for points that were all new;
///   kSplit    a new id (`other_id`) for points that shared most with `segment_id`;
///   kMerged   `other_id` is gone, most of its points now belong to `segment_id`;
///   kRetired  `segment_id` is gone and none of its points is left.
/// kGrown tells that an id that was there before has points it had not.
struct IdUpdate {
  std::vector<IdChange> changes;     ///< by ascending point
  std::vector<SegmentEvent> events;  ///< by type, then segment_id, then other_id
};

/// Persistent segment ids over a changing partition.
///
/// After each update a segment inherits the id of the old segment it shares most points with, ties
/// to the older (smaller) id. An id has one heir: of several segments that would inherit it, the
/// one that shares most, ties to the smaller representative. The others get new ids, from 1
/// upwards, by ascending representative. The same updates give the same ids.
class SegmentIds {
 public:
  /// Takes over the partition after an update of the engine; `components` and `changed` as in
  /// SegmentationEngine. Costs time in proportion to `changed` and to the changes returned.
  IdUpdate update(std::span<const PointIndex> components, std::span<const PointIndex> changed);

  /// The segment id of each point.
  std::span<const std::uint32_t> ids() const { return ids_; }
  /// The points of a segment, in no particular order; empty when there is no such segment.
  std::span<const PointIndex> points_of(std::uint32_t segment_id) const;
  /// Segments there are now.
  std::int64_t num_segments() const { return num_segments_; }
  /// Every id handed out so far is smaller.
  std::uint32_t next_id() const { return static_cast<std::uint32_t>(points_.size()); }

 private:
  std::vector<std::uint32_t> touched_rests(std::span<const Overlap> overlaps) const;
  void detach(PointIndex point);
  void attach(PointIndex point, std::uint32_t segment_id);

  std::vector<std::uint32_t> ids_;                  ///< of each point
  std::vector<std::uint32_t> slot_;                 ///< where each point stands in its segment
  std::vector<std::vector<PointIndex>> points_{1};  ///< of each segment by id; empty: gone
  std::int64_t num_segments_ = 0;
};

/// The ids of all points of a slice in its own order; kNoSegment for rejected points.
std::vector<std::uint32_t> slice_labels(const SliceRecord& slice,
                                        std::span<const std::uint32_t> ids);

/// The changes of points with an index below `end` as runs: consecutive points of one slice with
/// one new id. With `end` the first point of the newest slice these are the older points.
std::vector<LabelRun> label_runs(const PointCloud& cloud, std::span<const IdChange> changes,
                                 PointIndex end);

}  // namespace kintsugi::segmenter
