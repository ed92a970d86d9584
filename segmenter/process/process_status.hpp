#pragma once
// What the segmenter tells of itself.

#include <string>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "segmenter/process/update_publisher.hpp"
#include "segmenter/session/session_maps.hpp"

namespace kintsugi::segmenter {

/// The status now, without what the process alone knows: `session`, `mode`, `finished`,
/// `lingering`, `queue_bytes`, `problem`. What is about one map is about that of the newest
/// session; lag and missing slices are of all. Dropped slices count as bad messages.
SegmenterStatus make_status(const SessionMaps::Counts& maps, const StreamCounts& slices,
                            const UpdatePublisher::Counts& updates);

}  // namespace kintsugi::segmenter
