#pragma once
// A whole cloud as the slices of a session, and back.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/io/ply_reader.hpp"
#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// Slices by ascending id, and where each of their points stood in the cloud.
struct CloudSlices {
  std::vector<CloudSlice> slices;
  std::vector<std::vector<std::size_t>> input_indices;  ///< of each slice's points, ascending
};

/// Groups the points by slice_id; a cloud without is one slice, 0. The last one is final.
CloudSlices cut_into_slices(const PlyCloud& cloud, float resolution_m, const std::string& map_name);

/// Segments slices in order: all in one run where the mode is `batch`, else one by one.
/// @param progress called with the share of the points that is done, 0 to 1
/// @throws std::invalid_argument for an invalid config
std::unique_ptr<SegmentMap> segment_slices(const CloudSlices& slices,
                                           const SegmentMapConfig& config,
                                           const std::function<void(double)>& progress);

/// The segment id of each point of the cloud, kNoSegment where it was rejected.
std::vector<std::uint32_t> labels_in_input_order(const SegmentMap& map, const CloudSlices& slices);

}  // namespace kintsugi::segmenter
