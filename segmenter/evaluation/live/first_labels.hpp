#pragma once
// When each place of a map had its first label.

#include <Eigen/Core>
#include <optional>
#include <unordered_map>

#include "segmenter/evaluation/live/cells.hpp"

namespace kintsugi::segmenter {

class FirstLabels {
 public:
  /// @param radius_m within which a labelled point counts for a place, > 0
  explicit FirstLabels(double radius_m)
      : radius_m_(radius_m), cell_m_(radius_m / kCellsPerRadius) {}

  /// A point of a segment. @param now_s wall clock, which does not decrease
  void add(const Eigen::Vector3d& p_W, double now_s) {
    label_s_.try_emplace(cell_at(p_W, cell_m_), now_s);
  }

  /// The wall clock from which on there was a point of a segment within the radius, to the middle
  /// of its cell.
  std::optional<double> label_s(const Eigen::Vector3d& p_W) const;

 private:
  static constexpr int kCellsPerRadius = 4;

  double radius_m_;
  double cell_m_;
  std::unordered_map<CellKey, double, CellKeyHash> label_s_;
};

}  // namespace kintsugi::segmenter
