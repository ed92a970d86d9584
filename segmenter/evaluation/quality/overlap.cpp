#include "segmenter/evaluation/quality/overlap.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {
namespace {

using Labels = std::pair<std::uint32_t, std::uint32_t>;  // instance and segment of a point

/// The labels of the points that have an instance, ascending.
std::vector<Labels> sorted_labels(std::span<const std::uint32_t> instances,
                                  std::span<const std::uint32_t> segments) {
  std::vector<Labels> labels;
  labels.reserve(instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i] != kNoInstance) labels.emplace_back(instances[i], segments[i]);
  }
  std::ranges::sort(labels);
  return labels;
}

void score(const InstanceOverlap& overlap, InstanceScore& instance) {
  if (overlap.iou() <= instance.best_iou) return;
  instance.best_iou = overlap.iou();
  instance.best_segment = overlap.segment;
}

}  // namespace

OverlapTable overlap_table(std::span<const std::uint32_t> instances,
                           std::span<const std::uint32_t> segments) {
  if (instances.size() != segments.size()) {
    throw std::invalid_argument("instances of " + std::to_string(instances.size()) +
                                " points, segments of " + std::to_string(segments.size()) +
                                ": must be the same points");
  }
  const std::vector<Labels> labels = sorted_labels(instances, segments);
  OverlapTable table;
  table.num_points = std::ssize(labels);
  std::unordered_map<std::uint32_t, std::int64_t> segment_sizes;
  for (auto begin = labels.begin(); begin != labels.end();) {
    const auto end = std::upper_bound(begin, labels.end(), *begin);
    const auto [instance, segment] = *begin;
    if (table.instances.empty() || table.instances.back().instance != instance) {
      table.instances.push_back({.instance = instance});
    }
    table.instances.back().num_points += end - begin;
    if (segment != kNoSegment) {
      segment_sizes[segment] += end - begin;
      table.overlaps.push_back({.instance = instance, .segment = segment, .shared = end - begin});
    }
    begin = end;
  }
  auto of_instance = table.instances.begin();
  for (InstanceOverlap& overlap : table.overlaps) {
    while (of_instance->instance != overlap.instance) ++of_instance;
    overlap.instance_size = of_instance->num_points;
    overlap.segment_size = segment_sizes.at(overlap.segment);
    score(overlap, *of_instance);
  }
  return table;
}

double achievable_accuracy(const OverlapTable& table) {
  if (table.num_points == 0) return 0.0;
  std::unordered_map<std::uint32_t, std::int64_t> most_shared;  // by segment
  for (const InstanceOverlap& overlap : table.overlaps) {
    std::int64_t& most = most_shared[overlap.segment];
    most = std::max(most, overlap.shared);
  }
  std::int64_t num_right = 0;
  for (const auto& [segment, shared] : most_shared) num_right += shared;
  return static_cast<double>(num_right) / static_cast<double>(table.num_points);
}

double undersegmentation_error(const OverlapTable& table) {
  if (table.num_points == 0) return 0.0;
  std::int64_t leaked = 0;
  for (const InstanceOverlap& overlap : table.overlaps) {
    leaked += std::min(overlap.shared, overlap.segment_size - overlap.shared);
  }
  return static_cast<double>(leaked) / static_cast<double>(table.num_points);
}

}  // namespace kintsugi::segmenter
