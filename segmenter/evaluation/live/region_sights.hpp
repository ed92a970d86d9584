#pragma once
// When the camera has seen a region of surface long enough.

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "segmenter/evaluation/live/cells.hpp"

namespace kintsugi::segmenter {

/// Surface is in the mapper's map once it was observed in some frames. Of these the log has only
/// some views: a region that is in sight in two views one after the other was so in the frames
/// between them, too.
class RegionSights {
 public:
  /// @param cell_m side of a region, metres, > 0
  /// @param min_frames in which a region is in sight
  RegionSights(double cell_m, std::int64_t min_frames) : cell_m_(cell_m), min_frames_(min_frames) {}

  /// Points that are in sight in the next view.
  void add(std::int64_t frame_index, double now_s, const std::vector<Eigen::Vector3d>& points_W);

  /// The wall clock of the first view by which the region was in sight in enough frames.
  std::optional<double> seen_s(CellKey key) const;

 private:
  struct Sight {
    std::int64_t last_view = -1;
    std::int64_t num_frames = 0;
    double seen_s = -1.0;
  };

  double cell_m_;
  std::int64_t min_frames_;
  std::unordered_map<CellKey, Sight, CellHash> sights_;
  std::int64_t num_views_ = 0;
  std::int64_t last_frame_ = -1;
};

}  // namespace kintsugi::segmenter
