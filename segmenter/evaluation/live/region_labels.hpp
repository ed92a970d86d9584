#pragma once
// The labels of small regions of surface over time.

#include <Eigen/Core>
#include <cstdint>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "segmenter/evaluation/live/cells.hpp"

namespace kintsugi::segmenter {

/// Which segment took over whose points.
class Heirs {
 public:
  void add(std::uint32_t gone_id, std::uint32_t heir_id) { heir_[gone_id] = heir_id; }
  /// The segment into which this one was merged in the end; itself if it was not.
  std::uint32_t last_heir(std::uint32_t id) const;

 private:
  std::unordered_map<std::uint32_t, std::uint32_t> heir_;
};

/// A region: a cell of space with points of segments in it.
struct Region {
  std::vector<std::pair<std::uint32_t, std::int32_t>> counts;  ///< points, by segment id
  double first_label_s = -1.0;                                 ///< wall clock
  std::uint32_t label = 0;
  std::int32_t num_changes = 0;  ///< later than kNewborn_s after the first label
  bool is_touched = false;       ///< since the last settle()

  std::int32_t num_points() const;
};

/// A region has one label: it takes another one when that has more than twice as many points in it,
/// so that a region on the border of two segments does not count as changing.
class RegionLabels {
 public:
  static constexpr double kNewborn_s = 1.0;

  /// @param cell_m side of a region, metres, > 0
  explicit RegionLabels(double cell_m) : cell_m_(cell_m) {}

  double cell_m() const { return cell_m_; }
  void add_point(const Eigen::Vector3d& p_W, std::uint32_t segment_id, double now_s);
  void remove_point(const Eigen::Vector3d& p_W, std::uint32_t segment_id);
  /// Sets the labels of the regions whose points have changed.
  void settle(double now_s, const Heirs& heirs);

  const std::unordered_map<CellKey, Region, CellKeyHash>& regions() const { return regions_; }
  /// How often points went from one segment to another: each pair of segments once in a settle().
  std::int64_t num_handovers() const { return num_handovers_; }
  /// Of the changes of labels: those where one segment was merged into the other.
  std::int64_t num_changes_by_merge() const { return num_by_merge_; }

 private:
  Region& touch(const Eigen::Vector3d& p_W);

  double cell_m_;
  std::unordered_map<CellKey, Region, CellKeyHash> regions_;
  std::vector<CellKey> touched_;
  std::int64_t num_handovers_ = 0;
  std::int64_t num_by_merge_ = 0;
};

}  // namespace kintsugi::segmenter
