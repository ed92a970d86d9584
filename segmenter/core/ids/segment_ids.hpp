#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/ids/member_lists.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

struct Overlap;
struct Succession;

/// A point that came, went, or carries another segment id than before. A point that moved went
/// from one place and came to another.
struct IdChange {
  PointIndex point = 0;
  std::uint32_t old_id = kNoSegment;  ///< kNoSegment: it came
  std::uint32_t new_id = kNoSegment;  ///< kNoSegment: it went

  bool operator==(const IdChange&) const = default;
};

/// What one update of the partition means in terms of persistent ids.
///
/// Every birth and every death of an id is told by exactly one event:
///   kCreated  a new id for points that were all new;
///   kSplit    a new id (`other_id`) for points that shared most with `segment_id`;
///   kMerged   `other_id` is gone, most of its points now belong to `segment_id`;
///   kRetired  `segment_id` is gone and none of its points is left.
/// kGrown tells that an id that was there before has points it had not. A point that moved is the
/// same point.
struct IdUpdate {
  std::vector<IdChange> changes;     ///< by ascending point
  std::vector<SegmentEvent> events;  ///< by type, then segment_id, then other_id
};

/// Persistent segment ids over a changing partition.
///
/// After each update a segment inherits the id of the old segment it shares most points with, ties
/// to the older (smaller) id. An id has one heir: of several segments that would inherit it, the
/// one that shares most, ties to the one that has the first point by PointId. The others get new
/// ids, from 1 upwards, by their first points. So ids and events follow from the partitions alone,
/// whatever an engine calls its components and wherever the cloud keeps its points.
class SegmentIds {
 public:
  SegmentIds() = default;

  /// Goes on with ids that were given before: those of all points of a partition that are in the
  /// cloud. Throws std::invalid_argument naming the point when they are not one id in
  /// [1, next_id) for each component.
  SegmentIds(std::span<const ComponentId> components, std::span<const std::uint32_t> ids,
             std::uint32_t next_id);

  /// Takes over the partition after an update of the engine with `change`; `cloud` is as it was
  /// then, `components` and `changed` as in SegmentationEngine (more points may be given as
  /// changed). Costs time in proportion to `change`, `changed` and the changes returned.
  IdUpdate update(const PointCloud& cloud, const CloudChange& change,
                  std::span<const ComponentId> components, std::span<const PointIndex> changed);

  /// The segment id of each point, kNoSegment for those that are gone.
  std::span<const std::uint32_t> ids() const { return ids_.span(); }
  /// The points of a segment, in no particular order; none when there is no such segment.
  MemberLists::List points_of(std::uint32_t segment_id) const;
  std::int64_t num_points_of(std::uint32_t segment_id) const;
  /// What the engine calls a segment that has points.
  ComponentId component_of(std::uint32_t segment_id) const {
    return segments_[segment_id].component;
  }
  /// Segments there are now.
  std::int64_t num_segments() const { return static_cast<std::int64_t>(id_of_component_.size()); }
  /// Every id handed out so far is smaller.
  std::uint32_t next_id() const { return static_cast<std::uint32_t>(segments_.size()); }
  /// Memory in use.
  std::size_t bytes() const;

 private:
  struct Segment {
    PointIndex head = MemberLists::kEmpty;  ///< of its list of points
    std::uint32_t num_points = 0;           ///< 0: gone
    ComponentId component = 0;              ///< its name in the engine
  };

  void grow(PointIndex num_points);
  std::vector<std::uint32_t> take_out_removed(const CloudChange& change,
                                              std::vector<IdChange>& changes);
  void take_out_changed(const CloudChange& change, std::span<const PointIndex> changed,
                        std::vector<IdChange>& changes);
  std::vector<std::uint32_t> touched_by(std::span<const Overlap> overlaps,
                                        std::vector<std::uint32_t> losers) const;
  void find_first_points(const PointCloud& cloud, std::span<const ComponentId> components,
                         std::span<const PointIndex> changed,
                         std::span<const std::uint32_t> old_ids,
                         std::vector<Succession>& successions) const;
  void move_rests(std::span<const std::uint32_t> old_ids, std::span<const ComponentId> components,
                  std::span<const Succession> successions, std::vector<IdChange>& changes);
  void rename(std::span<const std::uint32_t> old_ids, std::span<const Succession> successions);
  void detach(PointIndex point);
  void attach(PointIndex point, std::uint32_t segment_id);

  GrowingArray<std::uint32_t> ids_;  ///< of each point
  MemberLists members_;
  GrowingArray<Segment> segments_{1};                     ///< by id
  std::map<ComponentId, std::uint32_t> id_of_component_;  ///< of those that there are
};

/// The ids of all points of a slice in its own order; kNoSegment for rejected points.
std::vector<std::uint32_t> slice_labels(const SliceRecord& slice,
                                        std::span<const std::uint32_t> ids);

/// The points that were there before and have another id, by slice and index in it, as runs:
/// consecutive points of one slice with one new id. Points that came are not among them.
std::vector<LabelRun> label_runs(const PointCloud& cloud, std::span<const IdChange> changes);

}  // namespace kintsugi::segmenter
