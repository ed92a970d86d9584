#include "segmenter/evaluation/session/session_cloud.hpp"

#include <iterator>
#include <utility>

#include "segmenter/io/cloud_slices.hpp"

namespace kintsugi::segmenter {
namespace {

std::vector<std::vector<std::uint32_t>> grouped_by_slice(
    const std::vector<std::uint32_t>& values,
    const std::vector<std::vector<std::size_t>>& indices_by_slice) {
  std::vector<std::vector<std::uint32_t>> grouped;
  grouped.reserve(indices_by_slice.size());
  for (const auto& indices : indices_by_slice) {
    auto& of_slice = grouped.emplace_back();
    of_slice.reserve(indices.size());
    for (const std::size_t i : indices) of_slice.push_back(values[i]);
  }
  return grouped;
}

}  // namespace

RecordedSession read_session_cloud(const std::filesystem::path& path,
                                   const CloudInputConfig& config) {
  const CloudInput input = read_cloud(path, config);
  RecordedSession session;
  session.source = path.string();
  CloudSlices cut = cut_into_slices(input.cloud, input.resolution_m, path.filename().string());
  for (CloudSlice& slice : cut.slices) {
    session.steps.push_back({});
    session.steps.back().slices.push_back(std::move(slice));
  }
  session.num_slices = std::ssize(session.steps);
  if (!input.cloud.segment_ids.empty()) {
    session.segment_ids = grouped_by_slice(input.cloud.segment_ids, cut.input_indices);
  }
  session.remarks.push_back("A cloud has no times: build time, length and Table II are left out.");
  if (input.cloud.slice_ids.empty()) {
    session.remarks.push_back("The cloud has no slice_id: it was evaluated as a single slice.");
  }
  return session;
}

}  // namespace kintsugi::segmenter
