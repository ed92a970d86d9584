#pragma once
// All that people ask of a segment.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/description/adjacency_graph.hpp"
#include "segmenter/description/labelled_cloud.hpp"
#include "segmenter/description/segment_shape.hpp"
#include "segmenter/map/last_change.hpp"

namespace kintsugi::segmenter {

struct SegmentDescription {
  SegmentStatistics statistics;  ///< points, axis-aligned box, centroid, normal, colour, area
  LastChange last_change;
  SegmentShape shape;                        ///< oriented box, plane
  std::vector<SegmentNeighbour> neighbours;  ///< by ascending id
};

/// Describes one segment of a map as it is now; nothing when no segment has this id. Takes time in
/// proportion to the points of the map (to look which are near), of the segment and of the
/// surroundings of its box.
std::optional<SegmentDescription> describe_segment(const SegmentMap& map, std::uint32_t segment_id);
/// The same for a copy of a map, which another thread may look at, or one that was read from files.
std::optional<SegmentDescription> describe_segment(const MapSnapshot& map,
                                                   std::uint32_t segment_id);

/// Describes every segment, by ascending id, by all cores: far cheaper than one after the other.
std::vector<SegmentDescription> describe_segments(const MapSnapshot& map);
/// The same of what is known already.
/// @param segments of the cloud: all of them, by ascending id
/// @param last_changes of each; or none: not known
/// @param graph of the cloud
std::vector<SegmentDescription> describe_segments(const LabelledCloud& cloud,
                                                  std::span<const SegmentStatistics> segments,
                                                  std::span<const LastChange> last_changes,
                                                  const AdjacencyGraph& graph);

}  // namespace kintsugi::segmenter
