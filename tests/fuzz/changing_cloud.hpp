#pragma once

#include <optional>
#include <span>
#include <vector>

#include "segmenter/core/point_cloud.hpp"
#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// The map of a scenario: a PointCloud whose points come and go one by one, and which index each
/// has.
///
/// Points are appended; those that leave stay behind, readable but not in the map.
class ChangingCloud {
 public:
  explicit ChangingCloud(std::span<const CloudPoint> pool) : pool_(pool), index_(pool.size()) {}

  /// Applies a step and tells what it changed.
  CloudChange apply(const Step& step);

  [[nodiscard]] const PointCloud& cloud() const { return cloud_; }
  /// The points in the map, ascending.
  [[nodiscard]] std::vector<PointIndex> live() const;
  /// The pool index of a point that is or was in the map.
  [[nodiscard]] PoolIndex pool_index(PointIndex point) const { return pool_index_[point]; }
  [[nodiscard]] bool contains(PoolIndex i) const { return index_[i].has_value(); }

 private:
  std::span<const CloudPoint> pool_;
  PointCloud cloud_;
  std::vector<std::optional<PointIndex>> index_;  ///< by pool index; none: not in the map
  std::vector<PoolIndex> pool_index_;             ///< by point
};

}  // namespace kintsugi::segmenter::fuzz
