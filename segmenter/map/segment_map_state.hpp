#pragma once
// A segment map as plain data: to be saved, and to be gone on with.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/last_change.hpp"

namespace kintsugi::segmenter {

struct SegmentMapConfig {
  std::string mode = "exact";  ///< one of engine_modes()
  EngineConfig engine;         ///< its resolution_m is replaced by that of the slices

  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Everything that decides what a SegmentMap will tell: one made from its state tells the same as
/// the map itself from then on. A copy: 36 bytes a point. Of the config, a file of it leaves out
/// what decides on time alone (rebuild_share and the like) and audit.
struct SegmentMapState {
  SegmentMapConfig config;
  std::int64_t session = 0;  ///< of the segmenter
  std::int64_t map_session = 0;
  std::string map_name;
  std::int32_t final_slice_id = -1;  ///< -1: not seen
  std::uint32_t next_id = 1;         ///< the segment id to be given next

  /// Chunks of the slice stream that are in the map, ascending: they need not be sent again.
  std::vector<SequenceRange> chunks;

  std::vector<SliceRecord> slices;         ///< in order of arrival; `first` is a place in points_W
  std::vector<CloudPoint> points_W;        ///< accepted points, slice after slice
  std::vector<std::uint32_t> segment_ids;  ///< of each of points_W

  /// Of each segment by ascending id. A SegmentMap has them; a snapshot may do without.
  std::vector<LastChange> last_changes;

  /// Mode `voting`, else empty: theta of each segment by ascending id. It depends on the history.
  std::vector<double> thetas;
};

}  // namespace kintsugi::segmenter
