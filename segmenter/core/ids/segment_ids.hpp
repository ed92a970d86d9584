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

/// A point that came, went, or has another segment id than before. A point that moved is one that
/// went, at its old index, and one that came, at its new one.
struct IdChange {
  PointIndex point = 0;
  std::uint32_t old_id = kNoSegment;  ///< kNoSegment: the point came
  std::uint32_t new_id = kNoSegment;  ///< kNoSegment: the point went

  bool operator==(const IdChange&) const = default;
};

/// An update of the partition in terms of persistent ids.
///
/// For every id that appears or disappears there is exactly one event:
///   kCreated  `segment_id` is new, and so are all its points;
///   kSplit    `other_id` is new; the old segment it shares most points with is `segment_id`;
///   kMerged   `other_id` is gone; most of its remaining points now belong to `segment_id`;
///   kRetired  `segment_id` is gone and none of its points is left.
/// kGrown: an id that existed before has points that it did not have. A point that moved counts as
/// the same point.
struct IdUpdate {
  std::vector<IdChange> changes;     ///< by ascending point
  std::vector<SegmentEvent> events;  ///< by type, then segment_id, then other_id
};

/// Persistent segment ids over a changing partition.
///
/// After each update a segment inherits the id of the old segment that it shares most points with;
/// on a tie the smaller id, which is the older one. Only one segment inherits an id: of several
/// candidates the one that shares most points with the old segment; on a tie the one with the
/// smallest PointId. The others get new ids, from 1 upwards, by their smallest PointIds. So ids and
/// events depend on the partitions alone, and neither on the names of components nor on
/// PointIndices.
class SegmentIds {
 public:
  SegmentIds() = default;

  /// Continues with given ids, one for each point (kNoComponent: ignored).
  /// @throws std::invalid_argument naming a point, unless each component has one id of its own in
  ///   [1, next_id)
  SegmentIds(std::span<const ComponentId> components, std::span<const std::uint32_t> ids,
             std::uint32_t next_id);

  /// To be called after an update of the engine with `change`, before `cloud` changes again.
  /// `components` and `changed` are those of the engine; `changed` may contain more points. Takes
  /// time proportional to `change`, `changed` and the changes returned.
  IdUpdate update(const PointCloud& cloud, const CloudChange& change,
                  std::span<const ComponentId> components, std::span<const PointIndex> changed);

  /// The segment id of each point, kNoSegment for those that are gone.
  std::span<const std::uint32_t> ids() const { return ids_.span(); }
  /// The points of a segment, in no particular order; empty when there is no such segment.
  MemberLists::List points_of(std::uint32_t segment_id) const;
  std::int64_t num_points_of(std::uint32_t segment_id) const;
  /// The name in the engine of a segment that has points.
  ComponentId component_of(std::uint32_t segment_id) const {
    return segments_[segment_id].component;
  }
  /// Segments that have points.
  std::int64_t num_segments() const { return static_cast<std::int64_t>(id_of_component_.size()); }
  /// The id that will be given next; larger than all so far.
  std::uint32_t next_id() const { return static_cast<std::uint32_t>(segments_.size()); }
  /// What is not used for long may go to disk from now on.
  void swap_to(SwapSpace& space) {
    ids_.swap_to(space);
    members_.swap_to(space);
    segments_.swap_to(space);
  }
  /// Memory in use.
  std::size_t bytes() const;

 private:
  struct Segment {
    PointIndex head = MemberLists::kEmpty;  ///< of its list in members_
    std::uint32_t num_points = 0;           ///< 0: gone
    ComponentId component = 0;              ///< its name in the engine
  };

  void grow(PointIndex num_points);
  std::vector<std::uint32_t> detach_removed(const CloudChange& change,
                                            std::vector<IdChange>& changes);
  void detach_changed(const CloudChange& change, std::span<const PointIndex> changed,
                      std::vector<IdChange>& changes);
  std::vector<std::uint32_t> touched_by(std::span<const Overlap> overlaps,
                                        std::vector<std::uint32_t> losers) const;
  void find_first_points(const PointCloud& cloud, std::span<const ComponentId> components,
                         std::span<const PointIndex> changed,
                         std::span<const std::uint32_t> old_ids,
                         std::vector<Succession>& successions) const;
  void detach_rests(std::span<const std::uint32_t> old_ids, std::span<const ComponentId> components,
                    std::span<const Succession> successions, std::vector<IdChange>& changes);
  void rename(std::span<const std::uint32_t> old_ids, std::span<const Succession> successions);
  void detach(PointIndex point);
  void attach(PointIndex point, std::uint32_t segment_id);

  GrowingArray<std::uint32_t> ids_;  ///< of each point
  MemberLists members_;
  GrowingArray<Segment> segments_{1};                     ///< by id
  std::map<ComponentId, std::uint32_t> id_of_component_;  ///< of segments that have points
};

}  // namespace kintsugi::segmenter
