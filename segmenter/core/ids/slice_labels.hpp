#pragma once
// Segment ids by slice, as segment updates carry them.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// The ids of all points of a slice as received; kNoSegment for rejected points.
std::vector<std::uint32_t> slice_labels(const SliceRecord& slice,
                                        std::span<const std::uint32_t> ids);

/// The changes of points that existed before and still exist, in the same revision of their slice,
/// as runs: consecutive points of one slice that have the same new id. By slice, then index in the
/// slice. `changes` are those of the last update of `ids`, and `moved` those of its CloudChange.
std::vector<LabelRun> label_runs(const PointCloud& cloud, std::span<const IdChange> changes,
                                 std::span<const MovedPoint> moved = {},
                                 std::span<const std::uint32_t> ids = {});

}  // namespace kintsugi::segmenter
