#pragma once
// Statistics, shape and neighbours of segments.

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

/// Describes one segment of a map as it is now; nothing when no segment has this id. Takes time
/// proportional to the points of the map.
std::optional<SegmentDescription> describe_segment(const SegmentMap& map, std::uint32_t segment_id);
/// The same for a copy of a map, or one that was read from files.
std::optional<SegmentDescription> describe_segment(const MapSnapshot& map,
                                                   std::uint32_t segment_id);

/// The same for a segment whose statistics are known. Of the cloud, only points within r of the
/// segment's box matter.
SegmentDescription describe_segment(const LabelledCloud& cloud, const SegmentStatistics& statistics,
                                    const LastChange& last_change);

/// Describes all segments, by ascending id, in parallel: much faster than one after the other.
std::vector<SegmentDescription> describe_segments(const MapSnapshot& map);
/// The same from statistics and a graph that are already known.
/// @param segments all segments of the cloud, by ascending id
/// @param last_changes of each segment; empty: not known
/// @param graph the adjacency graph of the cloud
std::vector<SegmentDescription> describe_segments(const LabelledCloud& cloud,
                                                  std::span<const SegmentStatistics> segments,
                                                  std::span<const LastChange> last_changes,
                                                  const AdjacencyGraph& graph);

}  // namespace kintsugi::segmenter
