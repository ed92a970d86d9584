#pragma once
// The adjacency of segments as a GraphML file.

#include <filesystem>
#include <span>

#include "segmenter/description/segment_description.hpp"

namespace kintsugi::segmenter {

/// Writes which segments touch as GraphML, which networkx, igraph and Gephi read. The graph is
/// undirected; a node has its segment's id as its id, and `points`, `area` (m^2), `x` `y` `z`
/// (centroid, metres, W) and `planar`; an edge has `pairs`, the number of pairs of neighbouring
/// points.
/// @param segments all of the graph's, by ascending id
/// @throws std::system_error naming the file and the reason
void write_graph(const AdjacencyGraph& graph, std::span<const SegmentDescription> segments,
                 const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
