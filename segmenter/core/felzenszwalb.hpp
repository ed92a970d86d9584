#pragma once

#include <cstdint>
#include <span>

#include "segmenter/core/edge.hpp"
#include "segmenter/core/segment_forest.hpp"

namespace kintsugi::segmenter {

/// Algorithm 1, lines 6-13: takes the edges in ascending order and joins what may be joined.
/// `edges` come in any order. Returns the number of joins.
std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest);

}  // namespace kintsugi::segmenter
