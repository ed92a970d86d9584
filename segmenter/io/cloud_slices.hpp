#pragma once
// Cuts a cloud into the slices of a session, and gives its labels back in the order of the file.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/io/points/file_cloud.hpp"
#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// Of all clouds: it does not tell one from another.
inline constexpr std::int64_t kCloudSession = 1;

/// Slices by ascending id, and where each of their points stood in the cloud.
struct CloudSlices {
  std::vector<CloudSlice> slices;
  std::vector<std::vector<std::size_t>> input_indices;  ///< of each slice's points, ascending
};

/// Groups the points by slice_id; a cloud without slice_id is one slice, 0. The last slice is
/// final.
CloudSlices cut_into_slices(const FileCloud& cloud, float resolution_m,
                            const std::string& map_name);

/// The segment id of each point of the cloud, kNoSegment where it was rejected.
std::vector<std::uint32_t> labels_in_input_order(const SegmentMap& map, const CloudSlices& slices);

}  // namespace kintsugi::segmenter
