#include "segmenter/io/cloud_slices.hpp"

#include <map>

#include "segmenter/core/ids/slice_labels.hpp"

namespace kintsugi::segmenter {

CloudSlices cut_into_slices(const FileCloud& cloud, float resolution_m,
                            const std::string& map_name) {
  std::map<std::int32_t, std::vector<std::size_t>> indices_by_id;
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    indices_by_id[cloud.slice_ids.empty() ? 0 : cloud.slice_ids[i]].push_back(i);
  }
  CloudSlices result;
  for (auto& [id, indices] : indices_by_id) {
    CloudSlice& slice = result.slices.emplace_back();
    slice.session = kCloudSession;
    slice.map_name = map_name;
    slice.id = id;
    slice.kind = SliceKind::kShiftPlusX;
    slice.resolution_m = resolution_m;
    slice.points_W.reserve(indices.size());
    for (const std::size_t i : indices) {
      slice.points_W.push_back(cloud.points_W[i]);
    }
    result.input_indices.push_back(std::move(indices));
  }
  if (!result.slices.empty()) {
    result.slices.back().kind = SliceKind::kFinal;
  }
  return result;
}

std::vector<std::uint32_t> labels_in_input_order(const SegmentMap& map, const CloudSlices& slices) {
  std::size_t num_points = 0;
  for (const auto& indices : slices.input_indices) {
    num_points += indices.size();
  }
  std::vector<std::uint32_t> labels(num_points, kNoSegment);
  const auto records = map.cloud().slices();
  for (std::size_t s = 0; s < slices.slices.size(); ++s) {
    const auto of_slice = slice_labels(records[s], map.segment_ids().ids());
    for (std::size_t i = 0; i < of_slice.size(); ++i) {
      labels[slices.input_indices[s][i]] = of_slice[i];
    }
  }
  return labels;
}

}  // namespace kintsugi::segmenter
