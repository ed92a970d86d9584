#include "segmenter/objects/changes/motion_between.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "segmenter/objects/maps/refine_alignment.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kTurns = 24;  // 15 degrees: the refinement turns half of it
// Two thirds of each are where the other is; a chair and a monitor can share a half.
constexpr double kLeastScore = 0.65;
// From different sides a camera sees half of a thing, and the other half.
constexpr double kMostPointsRatio = 2.5;
constexpr double kMostSizeRatio = 1.5;
constexpr float kAlike = 0.7F;
// Of mean colours, of 255: what shadows and the other sides of a thing make of them.
constexpr double kColorScale = 60.0;

struct Size {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  double height_m = 0.0;
  double width_m = 0.0;  ///< diagonal of the base
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
};

Size size_of(std::span<const CloudPoint> points, const Eigen::Matrix3d& R_WL) {
  Eigen::AlignedBox3d box_L;
  Size size;
  for (const CloudPoint& point : points) {
    box_L.extend(Eigen::Vector3d(R_WL.transpose() * position_of(point).cast<double>()));
    size.color += Eigen::Vector3d(point.red, point.green, point.blue);
  }
  size.center_W = R_WL * box_L.center();
  size.height_m = box_L.sizes().z();
  size.width_m = box_L.sizes().head<2>().norm();
  size.color /= static_cast<double>(points.size());
  return size;
}

bool is_alike(double a, double b, double slack_m) {
  return a <= kMostSizeRatio * b + slack_m && b <= kMostSizeRatio * a + slack_m;
}

/// Share of the samples that are on the surface.
double share_on(const ReferenceSurface& surface, const std::vector<CloudPoint>& samples,
                double reach_m) {
  const auto nearest = surface.nearest(samples);
  double num_on = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const CloudPoint& there = surface.samples()[nearest[i].index];
    const bool is_on = nearest[i].distance_m <= static_cast<float>(reach_m) &&
                       normal_of(there).dot(normal_of(samples[i])) >= kAlike;
    num_on += is_on ? 1.0 : 0.0;
  }
  return num_on / static_cast<double>(samples.size());
}

}  // namespace

std::optional<ObjectMotion> motion_between(std::span<const CloudPoint> before,
                                           std::span<const CloudPoint> after,
                                           const Eigen::Vector3d& up_W, double voxel_m) {
  if (before.empty() || after.empty()) return std::nullopt;
  const double ratio = static_cast<double>(before.size()) / static_cast<double>(after.size());
  if (ratio > kMostPointsRatio || ratio * kMostPointsRatio < 1.0) return std::nullopt;
  const Eigen::Matrix3d R_WL =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up_W).toRotationMatrix();
  const Size was = size_of(before, R_WL);
  const Size is = size_of(after, R_WL);
  const double slack_m = 2.0 * voxel_m;
  if (!is_alike(was.height_m, is.height_m, slack_m) ||
      !is_alike(was.width_m, is.width_m, slack_m)) {
    return std::nullopt;
  }
  const double likeness = std::exp(-std::pow((was.color - is.color).norm() / kColorScale, 2));
  if (likeness < kLeastScore) return std::nullopt;
  const double cell_m = std::max(1.5 * voxel_m, was.width_m / 40.0);  // a thousand of a chair
  const std::vector<CloudPoint> samples_before = surface_samples(before, cell_m);
  const std::vector<CloudPoint> samples_after = surface_samples(after, cell_m);
  if (samples_before.empty() || samples_after.empty()) return std::nullopt;
  const ReferenceSurface surface_before(samples_before);
  const ReferenceSurface surface_after(samples_after);
  const double reach_m = 1.2 * cell_m;
  std::optional<ObjectMotion> best;
  for (int turn = 0; turn < kTurns; ++turn) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(2.0 * std::numbers::pi * turn / kTurns, up_W).toRotationMatrix();
    X.translation() = is.center_W - X.linear() * was.center_W;
    const auto refined = refine_alignment(surface_after, samples_before, X,
                                          std::max(0.2 * was.width_m, 2.0 * cell_m), reach_m, true);
    if (!refined) continue;
    const Pose& X_AB = refined->X_AB;
    const double score =
        likeness *
        std::min(share_on(surface_after, transformed(X_AB, samples_before), reach_m),
                 share_on(surface_before, transformed(X_AB.inverse(Eigen::Isometry), samples_after),
                          reach_m));
    if (score >= kLeastScore && (!best || score > best->score)) best = ObjectMotion{X_AB, score};
  }
  return best;
}

}  // namespace kintsugi::segmenter
