#pragma once
// Which segments touch each other, and along how much of their boundary.

#include <cstdint>
#include <vector>

#include "segmenter/description/labelled_cloud.hpp"

namespace kintsugi::segmenter {

/// Two segments with neighbouring points.
struct AdjacencyEdge {
  std::uint32_t a = kNoSegment;
  std::uint32_t b = kNoSegment;  ///< > a
  /// Pairs of a point of `a` and one of `b` that are closer than r, > 0.
  std::int64_t num_pairs = 0;

  bool operator==(const AdjacencyEdge&) const = default;
};

struct AdjacencyGraph {
  std::vector<std::uint32_t> segment_ids;  ///< of all segments, ascending
  std::vector<AdjacencyEdge> edges;        ///< undirected, each once, by ascending (a, b)

  bool operator==(const AdjacencyGraph&) const = default;
};

/// Of the whole cloud, by all cores. The same whatever their number.
AdjacencyGraph adjacency_graph(const LabelledCloud& cloud);

/// A segment that another one touches.
struct SegmentNeighbour {
  std::uint32_t segment_id = kNoSegment;
  std::int64_t num_pairs = 0;  ///< as in AdjacencyEdge

  bool operator==(const SegmentNeighbour&) const = default;
};

/// The neighbours of one segment, by ascending id. Of `segment` the id and the axis-aligned box
/// count, which must be those of the cloud: points that are not within r of the box are passed
/// over.
std::vector<SegmentNeighbour> neighbours_of(const LabelledCloud& cloud,
                                            const SegmentStatistics& segment);

}  // namespace kintsugi::segmenter
