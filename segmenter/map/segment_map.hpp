#pragma once
// The segment map of one mapper session: slices in, segment updates out.

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "lcmtypes/sequence_set.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/segment_map_state.hpp"
#include "segmenter/map/segment_statistics.hpp"

namespace kintsugi::segmenter {

/// Combines cloud, engine, segment ids and statistics. A listener that applies the labels and
/// then the runs of each update, in order, has the labels of segment_ids().
class SegmentMap {
 public:
  /// @param session id of this run of the segmenter
  /// @param first a slice of the map, for its name, mapper session and resolution; it is not added
  /// @throws std::invalid_argument for an invalid config or a resolution that is not > 0
  SegmentMap(const SegmentMapConfig& config, std::int64_t session, const CloudSlice& first);

  /// Continues the map whose state() this is.
  /// @throws std::invalid_argument naming the reason when `state` is inconsistent
  explicit SegmentMap(const SegmentMapState& state);

  SegmentMap(const SegmentMap&) = delete;  // the engine refers to the cloud
  SegmentMap& operator=(const SegmentMap&) = delete;

  /// Adds slices and runs the engine once for all of them. A slice that is in the map with a lower
  /// revision is replaced: its points move. A correction moves the patches that it names, now or
  /// when they come (PatchMotions). Returns one update for each slice, in order. Each has the
  /// labels of its own points after all slices were added. The last one also has the relabelled
  /// points of other slices, moved ones included, the events and the statistics.
  ///
  /// @throws std::invalid_argument, and adds nothing, when a slice has another session or
  ///   resolution, is in the map with this or a higher revision, or comes twice
  std::vector<SegmentUpdate> add(std::span<const CloudSlice> slices);

  /// Chunks of revisions that are older than those in the map, and were never added to it: they
  /// need not be sent again.
  void skip_chunks(std::span<const SequenceRange> superseded) {
    for (const SequenceRange& range : superseded) chunks_.insert(range);
  }

  /// A hint, given before an add(): the add() after that one will probably bring `slice`.
  void look_ahead(const CloudSlice& slice) { engine_->look_ahead(slice.points_W); }

  /// The whole map as updates for a listener that has none of it: one for each slice, in order of
  /// arrival. The last one has the statistics of all segments.
  [[nodiscard]] std::vector<SegmentUpdate> describe() const;

  /// Everything that another SegmentMap needs to continue this one. If the engine failed in add(),
  /// the state can only be looked at: the points of that call have kNoSegment.
  [[nodiscard]] SegmentMapState state() const;
  /// The same into existing memory, which is several times as fast if it is large enough.
  void copy_state(SegmentMapState& state) const;

  /// The join threshold theta of a segment that has points.
  [[nodiscard]] double theta(std::uint32_t segment_id) const {
    return engine_->theta(ids_.component_of(segment_id));
  }

  /// True when the final slice is in the map.
  [[nodiscard]] bool has_final_slice() const { return final_slice_id_ >= 0; }

  /// True when the final slice and every earlier one are in the map, in their newest revisions as
  /// far as the final slice tells them.
  [[nodiscard]] bool is_complete() const;

  /// From now on what is not used for long may go to disk (mode `exact`), in chunks, whenever
  /// `space`, which must outlive the map, is trimmed: never while a call is at work.
  void swap_to(SwapSpace& space) {
    cloud_.swap_to(space);
    engine_->swap_to(space);
    ids_.swap_to(space);
    statistics_.swap_to(space);
  }

  /// Memory of points, engine, ids and statistics.
  [[nodiscard]] std::size_t bytes() const {
    return cloud_.bytes() + engine_->bytes() + ids_.bytes() + statistics_.bytes();
  }

  [[nodiscard]] const PointCloud& cloud() const { return cloud_; }
  [[nodiscard]] const SegmentIds& segment_ids() const { return ids_; }
  [[nodiscard]] const SegmentStatisticsTable& statistics() const { return statistics_; }
  [[nodiscard]] const SegmentMapConfig& config() const { return config_; }
  [[nodiscard]] std::int64_t session() const { return session_; }
  [[nodiscard]] std::int64_t map_session() const { return map_session_; }
  [[nodiscard]] const std::string& map_name() const { return map_name_; }
  /// A number that changes with every add().
  [[nodiscard]] std::int64_t version() const { return version_; }
  /// The chunks of the slice stream that are in the map, or older than what is in it.
  [[nodiscard]] const SequenceSet& chunks() const { return chunks_; }
  /// What corrections have told, also of patches that are not in the map.
  [[nodiscard]] const PatchMotions& motions() const { return motions_; }

 private:
  void check(const CloudSlice& slice) const;
  void store(const CloudSlice& slice);
  void move_patches(const CloudSlice& correction);
  [[nodiscard]] SegmentUpdate begin_update(const CloudSlice& slice) const;

  SegmentMapConfig config_;
  std::int64_t session_;
  std::int64_t map_session_;
  std::string map_name_;
  PointCloud cloud_;
  std::unique_ptr<SegmentationEngine> engine_;
  SegmentIds ids_;
  SegmentStatisticsTable statistics_;
  PatchMotions motions_;
  std::set<std::int32_t> slice_ids_;
  std::int64_t revision_sum_ = 0;        // of all slices in the map
  std::int32_t final_slice_id_ = -1;     // -1: not seen
  std::int64_t final_revision_sum_ = 0;  // what it said
  std::int64_t version_ = 0;
  SequenceSet chunks_;  // of the slice stream that need not be sent again
};

}  // namespace kintsugi::segmenter
