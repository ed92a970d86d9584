#pragma once
// A segment map as plain data, to be saved and continued.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/map/last_change.hpp"

namespace kintsugi::segmenter {

struct SegmentMapConfig {
  std::string mode = "exact";  ///< one of engine_modes()
  EngineConfig engine;         ///< resolution_m is replaced by that of the slices

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Everything that future updates of a SegmentMap depend on: a map made of its state gives the same
/// updates as the map itself. It is a copy of 36 bytes for each point. Of the config, a file holds
/// kMapParameters, the mode and the neighbour search.
struct SegmentMapState {
  SegmentMapConfig config;
  std::int64_t session = 0;      ///< of the segmenter
  std::int64_t map_session = 0;  ///< of the mapper
  std::string map_name;
  std::int32_t final_slice_id = -1;  ///< -1: not seen
  /// The final slice said so: the sum of the newest revisions of all slices; >= 0.
  std::int64_t final_revision_sum = 0;
  std::uint32_t next_id = 1;  ///< the next new segment id

  /// Chunks of the slice stream that are in the map, or are of revisions older than those in it,
  /// and need not be sent again; ascending.
  std::vector<SequenceRange> chunks;

  PatchMotions motions;  ///< what corrections have told, also of patches that are not in the map

  std::vector<SliceRecord> slices;   ///< in order of arrival; `first` is an index into points_W
  std::vector<CloudPoint> points_W;  ///< accepted points, slice after slice
  std::vector<std::uint32_t> segment_ids;  ///< of each of points_W

  /// Of each segment, by ascending id. Of a SegmentMap always; empty in a snapshot without them.
  std::vector<LastChange> last_changes;

  /// Mode `voting`: theta of each segment, by ascending id, since it depends on the past. Else
  /// empty.
  std::vector<double> thetas;
};

}  // namespace kintsugi::segmenter
