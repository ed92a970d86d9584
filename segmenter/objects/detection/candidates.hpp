#pragma once
// Which touching segments may together be one object.

#include <cstdint>
#include <functional>
#include <vector>

#include "segmenter/description/adjacency_graph.hpp"
#include "segmenter/objects/recognition/scene.hpp"

namespace kintsugi::segmenter {

/// A candidate has at most so many segments.
inline constexpr std::size_t kCandidateSegments = 5;

/// The neighbours of a segment.
using NeighboursOf = std::function<const std::vector<SegmentNeighbour>&(std::uint32_t)>;

/// The segment alone, and unions that grow from it by one neighbour after the other: once always by
/// the one with the longest common border, and once by that among the smaller ones, since what an
/// object stands on is often larger than the object. Unions whose box has a diagonal of more than
/// `largest_m` are not made. Each once; none if the segment itself is too large.
std::vector<Candidate> candidates_of(std::uint32_t segment, const LabelledMap& map,
                                     const NeighboursOf& neighbours_of, float largest_m);

}  // namespace kintsugi::segmenter
