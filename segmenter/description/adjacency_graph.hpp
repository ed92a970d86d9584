#pragma once
// Which segments touch each other, and by how many pairs of points.

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

/// The graph of the whole cloud. It is computed in parallel; the result is the same for any number
/// of threads.
AdjacencyGraph adjacency_graph(const LabelledCloud& cloud);

/// A neighbour of a given segment.
struct SegmentNeighbour {
  std::uint32_t segment_id = kNoSegment;
  std::int64_t num_pairs = 0;  ///< as in AdjacencyEdge

  bool operator==(const SegmentNeighbour&) const = default;
};

/// The neighbours of one segment, by ascending id. Of `segment` only the id and the axis-aligned
/// box are used: points that are not within r of the box are skipped.
std::vector<SegmentNeighbour> neighbours_of(const LabelledCloud& cloud,
                                            const SegmentStatistics& segment);

}  // namespace kintsugi::segmenter
