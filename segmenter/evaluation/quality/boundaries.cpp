#include "segmenter/evaluation/quality/boundaries.hpp"

#include <algorithm>
#include <string>

#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/evaluation/quality/overlap.hpp"

namespace kintsugi::segmenter {
namespace {

using Flags = std::vector<char>;  // of each point; not bool: threads write beside each other

/// The points that have an instance, and their labels.
struct KnownPoints {
  PointCloud cloud;
  std::vector<std::uint32_t> instances;
  std::vector<std::uint32_t> segments;
};

void take_known(std::span<const CloudPoint> points_W, std::span<const std::uint32_t> instances,
                std::span<const std::uint32_t> segments, KnownPoints& known) {
  std::vector<CloudPoint> known_W;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    if (instances[i] == kNoInstance) continue;
    known_W.push_back(points_W[i]);
    known.instances.push_back(instances[i]);
    known.segments.push_back(segments[i]);
  }
  known.cloud.add_slice(0, known_W);
  require(known.cloud.num_rejected() == 0,
          std::to_string(known.cloud.num_rejected()) + " points cannot be segmented, must be 0");
}

/// Flags the points that have a neighbour for which fits(point, neighbour) is true.
template <typename Fits>
Flags with_neighbour(const NeighbourIndex& index, std::size_t num_points, const Fits& fits) {
  Flags flags(num_points, 0);
  index.visit_all([&](PointIndex point, std::span<const PointIndex> neighbours) {
    flags[point] = static_cast<char>(std::ranges::any_of(
        neighbours, [&](PointIndex neighbour) { return fits(point, neighbour); }));
  });
  return flags;
}

Flags on_boundary(const NeighbourIndex& index, const std::vector<std::uint32_t>& labels) {
  return with_neighbour(index, labels.size(), [&](PointIndex point, PointIndex neighbour) {
    return labels[point] != labels[neighbour];
  });
}

std::int64_t count(const Flags& flags) { return std::ranges::count(flags, 1); }

}  // namespace

void BoundaryConfig::validate() const {
  require(radius_m > 0.0, "radius_m", radius_m, "> 0");
  require(tolerance_m >= 0.0 && tolerance_m < radius_m, "tolerance_m", tolerance_m,
          ">= 0 and < radius_m, " + std::to_string(radius_m));
}

BoundaryScore boundary_score(std::span<const CloudPoint> points_W,
                             std::span<const std::uint32_t> instances,
                             std::span<const std::uint32_t> segments,
                             const BoundaryConfig& config) {
  config.validate();
  require(instances.size() == points_W.size() && segments.size() == points_W.size(),
          std::to_string(points_W.size()) + " points, " + std::to_string(instances.size()) +
              " instances, " + std::to_string(segments.size()) + " segments: must be equal");
  KnownPoints known;
  take_known(points_W, instances, segments, known);
  const auto index = make_neighbour_index(NeighbourSearch::kGrid, known.cloud,
                                          static_cast<float>(config.radius_m));
  index->insert(known.cloud.everything().added);

  const Flags is_true = on_boundary(*index, known.instances);
  const Flags is_found = on_boundary(*index, known.segments);
  const auto tolerance_m2 = static_cast<float>(config.tolerance_m * config.tolerance_m);
  const auto share_near = [&](const Flags& of, const Flags& others) {
    if (count(of) == 0) return 1.0;
    Flags near = with_neighbour(*index, of.size(), [&](PointIndex point, PointIndex neighbour) {
      return others[neighbour] != 0 &&
             squared_distance(known.cloud[point], known.cloud[neighbour]) <= tolerance_m2;
    });
    for (std::size_t i = 0; i < of.size(); ++i) {
      near[i] = static_cast<char>(of[i] != 0 && (near[i] != 0 || others[i] != 0));
    }
    return static_cast<double>(count(near)) / static_cast<double>(count(of));
  };
  return {count(is_true), count(is_found), share_near(is_true, is_found),
          share_near(is_found, is_true)};
}

}  // namespace kintsugi::segmenter
