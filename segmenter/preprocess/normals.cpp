#include "segmenter/preprocess/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"
#include "segmenter/preprocess/normal_orientation.hpp"
#include "segmenter/preprocess/normal_sharpening.hpp"

namespace kintsugi::segmenter {
namespace {

Eigen::Vector3d position_W(const CloudPoint& p) { return {p.x, p.y, p.z}; }

struct FittedPlane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
  LocalPlane plane;
};

// The plane across the direction of least variance; none, of normal zero, when the points lie on a
// line.
FittedPlane fit_plane(std::span<const CloudPoint> points_W,
                      std::span<const std::uint32_t> neighbours) {
  // Relative to the nearest one, so that nothing cancels far from the origin.
  const Eigen::Vector3d origin_W = position_W(points_W[neighbours.front()]);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : neighbours) {
    const Eigen::Vector3d p = position_W(points_W[i]) - origin_W;
    mean += p;
    moments += p * p.transpose();
  }
  const auto count = static_cast<double>(neighbours.size());
  mean /= count;
  const Eigen::Matrix3d covariance = moments / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  // Thinner than a thousandth of its length, a neighbourhood is a line.
  constexpr double kMinVarianceRatio = 1e-6;
  const Eigen::Vector3d& variances = solver.eigenvalues();  // ascending
  if (!(variances[1] > kMinVarianceRatio * variances[2])) {
    return {};
  }
  const auto deviation = [&](int axis) {
    return static_cast<float>(std::sqrt(std::max(variances[axis], 0.0)));
  };
  return {.normal_W = solver.eigenvectors().col(0).normalized(),
          .plane = {.mean_W = (origin_W + mean).cast<float>(),
                    .thickness_m = deviation(0),
                    .width_m = deviation(1)}};
}

void set_normal(CloudPoint& point, const Eigen::Vector3d& normal_W) {
  point.nx = static_cast<float>(normal_W.x());
  point.ny = static_cast<float>(normal_W.y());
  point.nz = static_cast<float>(normal_W.z());
}

// Of a disc with so many points one step apart, rounded up.
int radius_in_steps(int num_points) {
  return static_cast<int>(std::ceil(std::sqrt(num_points / std::numbers::pi)));
}

Eigen::Vector3d mean_position_W(std::span<const CloudPoint> points_W) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : points_W) {
    sum += position_W(p);
  }
  return sum / static_cast<double>(std::max<std::size_t>(points_W.size(), 1));
}

}  // namespace

void NormalsConfig::validate() const {
  require(num_neighbours >= 3, "num_neighbours", num_neighbours, ">= 3");
  require(!viewpoint_W || viewpoint_W->allFinite(), "viewpoint_W is not finite");
}

std::int64_t estimate_normals(std::span<CloudPoint> points_W, const NormalsConfig& config,
                              const std::function<void(double)>& progress) {
  config.validate();
  const NearestNeighbours tree(points_W);
  NeighbourGraph graph(points_W.size());
  std::vector<LocalPlane> planes(points_W.size());
  constexpr std::size_t kBatch = 1 << 18;  // between two reports
  constexpr std::size_t kGrain = 1 << 10;
  for (std::size_t begin = 0; begin < points_W.size(); begin += kBatch) {
    const std::size_t end = std::min(begin + kBatch, points_W.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, kGrain), [&](const auto& range) {
      NearestNeighbours::Result found;
      tree.find(points_W.subspan(range.begin(), range.size()), config.num_neighbours + 1, found);
      const auto count = static_cast<std::size_t>(found.count);
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const std::span<const std::uint32_t> neighbours(
            found.indices.data() + (i - range.begin()) * count, count);
        const FittedPlane fitted = fit_plane(points_W, neighbours);
        set_normal(points_W[i], fitted.normal_W);
        planes[i] = fitted.plane;
        graph.set_neighbours(i, neighbours);
      }
    });
    if (progress) {
      progress(static_cast<double>(end) / static_cast<double>(points_W.size()));
    }
  }
  orient_normals(points_W, graph, config.viewpoint_W.value_or(mean_position_W(points_W)));
  sharpen_normals(points_W, planes, graph, radius_in_steps(config.num_neighbours) + 1);
  return std::count_if(points_W.begin(), points_W.end(), [](const CloudPoint& p) {
    return p.nx == 0.0F && p.ny == 0.0F && p.nz == 0.0F;
  });
}

void estimate_missing_normals(std::span<CloudPoint> points_W, const NormalsConfig& config) {
  config.validate();
  std::vector<std::size_t> missing;
  std::vector<CloudPoint> queries_W;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    if (!lacks_normal(points_W[i])) continue;
    missing.push_back(i);
    queries_W.push_back(points_W[i]);
  }
  if (missing.empty()) return;
  NearestNeighbours::Result found;
  NearestNeighbours(points_W).find(queries_W, config.num_neighbours + 1, found);
  const auto count = static_cast<std::size_t>(found.count);
  // All are computed from the given ones, so that the order of the points does not matter.
  for (std::size_t k = 0; k < missing.size(); ++k) {
    const std::span<const std::uint32_t> neighbours(found.indices.data() + k * count, count);
    Eigen::Vector3d sum_W = Eigen::Vector3d::Zero();
    for (const std::uint32_t j : neighbours) {
      const CloudPoint& p = points_W[j];
      if (!lacks_normal(p)) sum_W += Eigen::Vector3d(p.nx, p.ny, p.nz);
    }
    const Eigen::Vector3d normal_W = fit_plane(points_W, neighbours).normal_W;
    set_normal(queries_W[k], normal_W.dot(sum_W) < 0.0 ? Eigen::Vector3d(-normal_W) : normal_W);
  }
  for (std::size_t k = 0; k < missing.size(); ++k) points_W[missing[k]] = queries_W[k];
}

bool lacks_normal(const CloudPoint& point) {
  const float squared_length = point.nx * point.nx + point.ny * point.ny + point.nz * point.nz;
  return !std::isfinite(squared_length) || squared_length == 0.0F;
}

}  // namespace kintsugi::segmenter
