#include "segmenter/objects/recognition/view_descriptor.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

namespace {

constexpr std::size_t kFewestPoints = 3;
constexpr int kTurns = 8;  // a face that is in view at one turn is at the next, too
// As a person who walks sees things on the floor and on tables, and those at the height of the
// eyes.
constexpr std::array<float, 2> kElevations_rad = {0.1F, 0.7F};

Eigen::Vector3f direction(int turn, float elevation_rad) {
  const float azimuth_rad =
      2 * std::numbers::pi_v<float> * static_cast<float>(turn) / static_cast<float>(kTurns);
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

/// The points that are the first in their cell of an image along `towards`, or nearly so.
std::vector<std::size_t> seen_from(const Surface& surface, const Eigen::Vector3f& towards,
                                   float spacing_m) {
  const Eigen::Matrix3f R =
      Eigen::Quaternionf::FromTwoVectors(towards, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const float cell_m = 2 * spacing_m;  // without holes between the points
  std::map<std::pair<int, int>, float> nearest;
  const auto cell_of = [&](const Eigen::Vector3f& p) {
    return std::pair(static_cast<int>(std::floor(p.x() / cell_m)),
                     static_cast<int>(std::floor(p.y() / cell_m)));
  };
  for (const SurfacePoint& point : surface) {
    const Eigen::Vector3f p = R * point.position;
    const auto [at, is_new] = nearest.try_emplace(cell_of(p), p.z());
    if (!is_new) at->second = std::max(at->second, p.z());
  }
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const float facing = surface[i].normal.dot(towards);
    if (facing < kGrazing) continue;
    const Eigen::Vector3f p = R * surface[i].position;
    // Within a cell a surface that is seen at this angle is as deep as this.
    const float depth_m = cell_m / facing;
    if (p.z() >= nearest[cell_of(p)] - depth_m) seen.push_back(i);
  }
  return seen;
}

Eigen::Vector3f principal_lengths_m(const SurfaceMoments& moments) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.covariance_m2(),
                                                              Eigen::EigenvaluesOnly);
  return solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt().cast<float>();
}

}  // namespace

SizeAndColors size_and_colors(const SurfaceMoments& moments, float spacing_m) {
  SizeAndColors elements;
  elements.head<3>() = (principal_lengths_m(moments).array() + spacing_m).log();
  elements[3] = std::log(static_cast<float>(moments.points) * spacing_m * spacing_m);
  elements.segment<3>(4) = moments.mean_lab().cast<float>();
  elements.tail<3>() = moments.lab_variance().cwiseSqrt().cast<float>();
  return elements;
}

ViewDescriptor view_descriptor(const SizeAndColors& beginning, const ShapeFeature& mean_features) {
  ViewDescriptor descriptor;
  descriptor << beginning, mean_features;
  return descriptor;
}

std::vector<std::vector<std::size_t>> simulated_views(const Surface& surface, float spacing_m) {
  std::vector<std::vector<std::size_t>> views;
  const auto add = [&views](std::vector<std::size_t> view) {
    if (view.size() >= kFewestPoints) views.push_back(std::move(view));
  };
  std::vector<std::size_t> all(surface.size());
  std::iota(all.begin(), all.end(), 0);
  add(std::move(all));
  for (const float elevation_rad : kElevations_rad) {
    for (int turn = 0; turn < kTurns; ++turn) {
      add(seen_from(surface, direction(turn, elevation_rad), spacing_m));
    }
  }
  return views;
}

Surface points_of(const Surface& surface, const std::vector<std::size_t>& view) {
  Surface points;
  points.reserve(view.size());
  for (const std::size_t i : view) points.push_back(surface[i]);
  return points;
}

ShapeFeatures features_of(const ShapeFeatures& features, const std::vector<std::size_t>& view) {
  ShapeFeatures chosen(kShapeFeatureSize, static_cast<Eigen::Index>(view.size()));
  for (std::size_t i = 0; i < view.size(); ++i) {
    chosen.col(static_cast<Eigen::Index>(i)) = features.col(static_cast<Eigen::Index>(view[i]));
  }
  return chosen;
}

}  // namespace kintsugi::segmenter
