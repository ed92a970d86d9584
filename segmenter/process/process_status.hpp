#pragma once
// What the segmenter tells of itself.

#include "lcmtypes/messages.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "segmenter/process/slice_processor.hpp"

namespace kintsugi::segmenter {

/// The status now, without `session`, `mode` and `finished`. Dropped slices count as bad messages.
SegmenterStatus make_status(const SliceProcessor::Counts& counts, const StreamCounts& stream);

}  // namespace kintsugi::segmenter
