#include "segmenter/objects/changes/filled_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/objects/model/shortest_rotation.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kDirections = 49;

/// On half a sphere, by a Fibonacci spiral about z up to the equator: 20 degrees apart.
const std::array<Eigen::Vector3f, kDirections>& directions() {
  static const std::array<Eigen::Vector3f, kDirections> kAll = [] {
    std::array<Eigen::Vector3f, kDirections> all;
    constexpr float kTurn = std::numbers::pi_v<float> * (3.0F - 2.2360680F);
    for (std::size_t i = 0; i < kDirections; ++i) {
      const float z = static_cast<float>(i) / static_cast<float>(kDirections - 1);
      const float r = std::sqrt(1.0F - z * z);
      const float turn = kTurn * static_cast<float>(i);
      all[i] = {r * std::cos(turn), r * std::sin(turn), z};
    }
    return all;
  }();
  return kAll;
}

}  // namespace

FilledSpace::FilledSpace(std::span<const CloudPoint> surface, const Eigen::Vector3d& up)
    : R_UW_(shortest_rotation(up, Eigen::Vector3d::UnitZ()).toRotationMatrix().cast<float>()) {
  bounds_.reserve(kDirections);
  for (const Eigen::Vector3f& direction : directions()) {
    Bounds bounds{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (const CloudPoint& point : surface) {
      const float along = direction.dot(R_UW_ * position_of(point));
      bounds = {std::min(bounds.least, along), std::max(bounds.most, along)};
    }
    bounds_.push_back(bounds);
  }
}

bool FilledSpace::contains(const Eigen::Vector3f& p, float margin_m) const {
  const Eigen::Vector3f p_U = R_UW_ * p;
  for (std::size_t i = 0; i < kDirections; ++i) {
    const float along = directions()[i].dot(p_U);
    if (along < bounds_[i].least + margin_m || along > bounds_[i].most - margin_m) return false;
  }
  return true;
}

}  // namespace kintsugi::segmenter
