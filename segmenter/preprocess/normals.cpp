#include "segmenter/preprocess/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"
#include "segmenter/preprocess/normal_orientation.hpp"

namespace kintsugi::segmenter {
namespace {

Eigen::Vector3d position_W(const CloudPoint& p) { return {p.x, p.y, p.z}; }

// The direction of least variance; zero when the points lie on a line.
Eigen::Vector3d plane_normal(std::span<const CloudPoint> points_W,
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
    return Eigen::Vector3d::Zero();
  }
  return solver.eigenvectors().col(0).normalized();
}

void set_normal(CloudPoint& point, const Eigen::Vector3d& normal_W) {
  point.nx = static_cast<float>(normal_W.x());
  point.ny = static_cast<float>(normal_W.y());
  point.nz = static_cast<float>(normal_W.z());
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
        set_normal(points_W[i], plane_normal(points_W, neighbours));
        graph.set_neighbours(i, neighbours);
      }
    });
    if (progress) {
      progress(static_cast<double>(end) / static_cast<double>(points_W.size()));
    }
  }
  orient_normals(points_W, graph, config.viewpoint_W.value_or(mean_position_W(points_W)));
  return std::count_if(points_W.begin(), points_W.end(), [](const CloudPoint& p) {
    return p.nx == 0.0F && p.ny == 0.0F && p.nz == 0.0F;
  });
}

}  // namespace kintsugi::segmenter
