#include "segmenter/objects/maps/refine_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kIterations = 40;
constexpr double kShrink = 0.85;   // of the distance, in each iteration
constexpr double kAlike = 0.7;     // cosine between normals: 45 degrees
constexpr double kSettled = 1e-4;  // a step of 0.1 mm, a hundredth of a voxel
constexpr int kLeastMatches = 30;
// Residuals of samples less than this apart are alike, as the errors of depth and map are.
constexpr double kAlikeWithin_m = 0.25;

struct System {
  Matrix6 A = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  double squares_m2 = 0.0;
  double num_matches = 0.0;
};

/// Rotation first, about `center`, then translation.
System system_of(const ReferenceSurface& surface_A, const std::vector<CloudPoint>& samples_A,
                 const Eigen::Vector3d& center, double reach_m) {
  const auto nearest = surface_A.nearest(samples_A);
  System system;
  for (std::size_t i = 0; i < samples_A.size(); ++i) {
    if (nearest[i].distance_m > reach_m) continue;
    const CloudPoint& on_A = surface_A.samples()[nearest[i].index];
    const Eigen::Vector3d n = normal_of(on_A).cast<double>();
    if (n.dot(normal_of(samples_A[i]).cast<double>()) < kAlike) continue;
    const Eigen::Vector3d p = position_of(samples_A[i]).cast<double>();
    const double residual_m = n.dot(p - position_of(on_A).cast<double>());
    // Tukey's weight: the residual of a match on another surface is as large as the reach.
    const double share = residual_m / reach_m;
    const double weight = (1.0 - share * share) * (1.0 - share * share);
    Vector6 J;
    J << (p - center).cross(n), n;
    system.A += weight * J * J.transpose();
    system.b -= weight * residual_m * J;
    system.squares_m2 += weight * residual_m * residual_m;
    system.num_matches += weight;
  }
  return system;
}

Pose motion_of(const Vector6& x, const Eigen::Vector3d& center) {
  Pose motion = Pose::Identity();
  const Eigen::Vector3d rotation = x.head<3>();
  const double angle = rotation.norm();
  if (angle > 0.0) motion.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  motion.translation() = center + x.tail<3>() - motion.linear() * center;
  return motion;
}

Eigen::Vector3d center_of(const std::vector<CloudPoint>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& sample : samples) sum += position_of(sample).cast<double>();
  return sum / static_cast<double>(std::max<std::size_t>(1, samples.size()));
}

double mean_spacing_m(const std::vector<CloudPoint>& samples) {
  return samples.size() < 13 ? 0.0 : median_spacing_m(samples);
}

}  // namespace

ReferenceSurface::ReferenceSurface(std::vector<CloudPoint> samples_A)
    : samples_(std::move(samples_A)), tree_(samples_) {}

std::vector<ReferenceSurface::Nearest> ReferenceSurface::nearest(
    std::span<const CloudPoint> places_A) const {
  std::vector<Nearest> nearest(places_A.size());
  constexpr std::size_t kGrain = 1'000;
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<std::size_t>(0, places_A.size(), kGrain), [&](const auto& range) {
        NearestNeighbours::Result result;
        tree_.find(places_A.subspan(range.begin(), range.size()), 1, result);
        for (std::size_t i = 0; i < range.size(); ++i) {
          nearest[range.begin() + i] = {result.indices[i], std::sqrt(result.squared_distances[i])};
        }
      });
  return nearest;
}

std::optional<RefinedAlignment> refine_alignment(const ReferenceSurface& surface_A,
                                                 std::span<const CloudPoint> samples_B,
                                                 const Pose& X_AB, double begin_m, double end_m,
                                                 bool may_slide) {
  if (samples_B.empty() || surface_A.samples().empty()) return std::nullopt;
  RefinedAlignment result;
  result.X_AB = X_AB;
  System system;
  double reach_m = begin_m;
  for (int i = 0; i < kIterations; ++i) {
    const std::vector<CloudPoint> samples_A = transformed(result.X_AB, samples_B);
    const Eigen::Vector3d center = center_of(samples_A);
    system = system_of(surface_A, samples_A, center, reach_m);
    if (system.num_matches < kLeastMatches) return std::nullopt;
    // In units of the mean square of each unknown's effect, so that one number says "not held".
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(system.A / system.num_matches);
    constexpr double kHeld = 1e-4;  // a hundredth of a metre's lever, or of the normals
    if (!may_slide && eigen.eigenvalues()[0] < kHeld) return std::nullopt;
    // What is not held stays: 1e-6 is a millimetre's lever.
    system.A += 1e-6 * system.num_matches * Matrix6::Identity();
    const Vector6 x = system.A.ldlt().solve(system.b);
    result.X_AB = motion_of(x, center) * result.X_AB;
    const bool is_final_reach = reach_m <= end_m;
    if (is_final_reach && x.norm() < kSettled) break;
    reach_m = std::max(end_m, kShrink * reach_m);
  }
  result.X_AB.linear() = Eigen::Quaterniond(result.X_AB.linear()).normalized().toRotationMatrix();
  result.rms_m = std::sqrt(system.squares_m2 / system.num_matches);
  result.matched = system.num_matches / static_cast<double>(samples_B.size());
  const double spacing_m = mean_spacing_m({samples_B.begin(), samples_B.end()});
  const double alike = std::max(1.0, std::pow(kAlikeWithin_m / std::max(spacing_m, 1e-3), 2));
  const Matrix6 covariance = system.A.inverse() * (result.rms_m * result.rms_m * alike);
  const auto worst = [](const Eigen::Matrix3d& block) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues()[2]);
  };
  result.sigma_rad = worst(covariance.topLeftCorner<3, 3>());
  result.sigma_m = worst(covariance.bottomRightCorner<3, 3>());
  return result;
}

}  // namespace kintsugi::segmenter
