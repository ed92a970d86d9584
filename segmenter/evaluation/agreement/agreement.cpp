#include "segmenter/evaluation/agreement/agreement.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::segmenter {

std::vector<SegmentAgreement> mutual_overlap(std::span<const std::uint32_t> labels,
                                             std::span<const std::uint32_t> reference) {
  require(labels.size() == reference.size(),
          "labels of " + std::to_string(labels.size()) + " points, reference of " +
              std::to_string(reference.size()) + ": must be the same points");
  std::unordered_map<std::uint32_t, std::int64_t> reference_sizes;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    ++reference_sizes[reference[i]];
    pairs[i] = {labels[i], reference[i]};
  }
  std::sort(pairs.begin(), pairs.end());

  std::vector<SegmentAgreement> agreements;
  for (auto segment = pairs.begin(); segment != pairs.end();) {
    const auto segment_end = std::find_if(
        segment, pairs.end(), [&](const auto& pair) { return pair.first != segment->first; });
    const std::int64_t size = segment_end - segment;
    double v = 0.0;
    for (auto shared = segment; shared != segment_end;) {
      const auto shared_end = std::find_if(
          shared, segment_end, [&](const auto& pair) { return pair.second != shared->second; });
      const auto larger = std::max(size, reference_sizes[shared->second]);
      v = std::max(v, static_cast<double>(shared_end - shared) / static_cast<double>(larger));
      shared = shared_end;
    }
    agreements.push_back({segment->first, size, v});
    segment = segment_end;
  }
  return agreements;
}

AgreementSummary summarize(std::span<const SegmentAgreement> agreements, std::int64_t min_points) {
  AgreementSummary summary;
  for (const SegmentAgreement& segment : agreements) {
    if (segment.num_points < min_points) continue;
    const auto points = static_cast<double>(segment.num_points);
    ++summary.num_segments;
    summary.num_points += segment.num_points;
    summary.mean_v += segment.v;
    summary.point_mean_v += segment.v * points;
    if (segment.v == 1.0) {
      summary.exact_share += 1.0;
      summary.exact_point_share += points;
    }
  }
  if (summary.num_segments == 0) return summary;
  summary.mean_v /= static_cast<double>(summary.num_segments);
  summary.exact_share /= static_cast<double>(summary.num_segments);
  summary.point_mean_v /= static_cast<double>(summary.num_points);
  summary.exact_point_share /= static_cast<double>(summary.num_points);
  return summary;
}

}  // namespace kintsugi::segmenter
