#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "segmenter/core/points/point_cloud.hpp"
#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// The map of a scenario. Consecutive points of the pool are one slice. When some of them come or
/// go, the slice is replaced: even a point that stays gets another index, as after a correction.
/// With slices of one point, points come and go one by one.
class ChangingCloud {
 public:
  explicit ChangingCloud(const Scenario& scenario)
      : pool_(scenario.pool),
        slice_points_(scenario.slice_points),
        is_in_(scenario.pool.size(), false) {}

  /// Applies a step and returns the change of the cloud.
  CloudChange apply(const Step& step);

  [[nodiscard]] const PointCloud& cloud() const { return cloud_; }
  /// The points in the map, ascending.
  [[nodiscard]] std::vector<PointIndex> live() const;

 private:
  void renew_slice(std::int32_t slice_id);

  std::span<const CloudPoint> pool_;
  std::size_t slice_points_;
  std::vector<bool> is_in_;  ///< by pool index
  PointCloud cloud_;
};

}  // namespace kintsugi::segmenter::fuzz
