#include "segmenter/preprocess/cloud_preparation.hpp"

#include <algorithm>
#include <cmath>

#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/points/admission.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

std::vector<CloudPoint> with_usable_position(std::span<const CloudPoint> points_W) {
  std::vector<CloudPoint> usable_W;
  std::copy_if(points_W.begin(), points_W.end(), std::back_inserter(usable_W),
               [](const CloudPoint& p) { return !reason_to_reject_position(p); });
  return usable_W;
}

/// Calls `compute` with the points whose position is admissible, and takes what it makes of them.
template <class Compute>
void on_usable(std::span<CloudPoint> points_W, const Compute& compute) {
  std::vector<CloudPoint> usable_W = with_usable_position(points_W);
  compute(usable_W);
  auto next = usable_W.begin();
  for (CloudPoint& p : points_W) {
    if (!reason_to_reject_position(p)) {
      p = *next++;
    }
  }
}

Eigen::Vector3d normal_W(const CloudPoint& p) { return {p.nx, p.ny, p.nz}; }

}  // namespace

std::int64_t normalize_normals(std::span<CloudPoint> points_W) {
  constexpr double kTolerance = 1e-4;  // of a normal written with four decimals
  constexpr double kMinLength = 1e-6;
  std::int64_t num_scaled = 0;
  for (CloudPoint& p : points_W) {
    const Eigen::Vector3d given_W = normal_W(p);
    const double length = given_W.norm();
    if (!std::isfinite(length) || length < kMinLength || std::abs(length - 1.0) <= kTolerance) {
      continue;
    }
    const Eigen::Vector3f unit_W = (given_W / length).cast<float>();
    p.nx = unit_W.x();
    p.ny = unit_W.y();
    p.nz = unit_W.z();
    ++num_scaled;
  }
  return num_scaled;
}

void compute_normals(std::span<CloudPoint> points_W, const NormalsConfig& config,
                     const std::function<void(double)>& progress) {
  on_usable(points_W, [&](auto& usable_W) { estimate_normals(usable_W, config, progress); });
}

void compute_missing_normals(std::span<CloudPoint> points_W, const NormalsConfig& config) {
  on_usable(points_W, [&](auto& usable_W) { estimate_missing_normals(usable_W, config); });
}

NormalCount count_missing_normals(std::span<const CloudPoint> points_W) {
  NormalCount count;
  for (const CloudPoint& p : points_W) {
    if (reason_to_reject_position(p)) continue;
    ++count.num_points;
    if (lacks_normal(p)) ++count.num_missing;
  }
  return count;
}

void average_normals(std::span<CloudPoint> points_W, float radius_m) {
  PointCloud cloud;
  const SliceRecord slice = cloud.add_slice(0, points_W);
  const auto index = make_neighbour_index(NeighbourSearch::kGrid, cloud, radius_m);
  index->insert(cloud.take_change().added);
  index->visit_all([&](PointIndex i, std::span<const PointIndex> neighbours) {
    const Eigen::Vector3d own_W = normal_W(cloud[i]);
    Eigen::Vector3d sum_W = own_W;
    for (const PointIndex j : neighbours) {
      const Eigen::Vector3d other_W = normal_W(cloud[j]);
      if (other_W.dot(own_W) > 0.0) sum_W += other_W;
    }
    const Eigen::Vector3f mean_W = sum_W.normalized().cast<float>();
    CloudPoint& p = points_W[static_cast<std::size_t>(slice.index_of(i))];
    p.nx = mean_W.x();
    p.ny = mean_W.y();
    p.nz = mean_W.z();
  });
}

float usable_spacing_m(std::span<const CloudPoint> points_W) {
  return median_spacing_m(with_usable_position(points_W));
}

std::vector<Rejection> count_rejections(std::span<const CloudPoint> points_W) {
  std::vector<Rejection> rejections;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const auto reason = reason_to_reject(points_W[i]);
    if (!reason) {
      continue;
    }
    auto entry = std::find_if(rejections.begin(), rejections.end(),
                              [&](const Rejection& r) { return r.reason == *reason; });
    if (entry == rejections.end()) {
      entry = rejections.insert(entry, {*reason, 0, static_cast<std::int64_t>(i)});
    }
    ++entry->count;
  }
  return rejections;
}

}  // namespace kintsugi::segmenter
