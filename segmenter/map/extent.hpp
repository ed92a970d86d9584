#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The axis-aligned bounding box of points, frame W, and the slices they came with.
struct Extent {
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  std::array<float, 3> min_W = {kInfinity, kInfinity, kInfinity};
  std::array<float, 3> max_W = {-kInfinity, -kInfinity, -kInfinity};
  std::int32_t first_slice = INT32_MAX;
  std::int32_t last_slice = INT32_MIN;

  void include(const CloudPoint& point, std::int32_t slice_id) {
    const std::array<float, 3> p_W{point.x, point.y, point.z};
    include({p_W, p_W, slice_id, slice_id});
  }
  void include(const Extent& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      min_W[axis] = std::min(min_W[axis], other.min_W[axis]);
      max_W[axis] = std::max(max_W[axis], other.max_W[axis]);
    }
    first_slice = std::min(first_slice, other.first_slice);
    last_slice = std::max(last_slice, other.last_slice);
  }

  [[nodiscard]] bool is_empty() const { return first_slice > last_slice; }

  /// Whether the extent may shrink when `point`, which it includes, is removed.
  [[nodiscard]] bool touches(const CloudPoint& point, std::int32_t slice_id) const {
    const std::array<float, 3> p_W{point.x, point.y, point.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (p_W[axis] <= min_W[axis] || p_W[axis] >= max_W[axis]) {
        return true;
      }
    }
    return slice_id == first_slice || slice_id == last_slice;
  }
};

}  // namespace kintsugi::segmenter
