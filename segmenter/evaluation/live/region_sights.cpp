#include "segmenter/evaluation/live/region_sights.hpp"

#include <algorithm>

namespace kintsugi::segmenter {

void RegionSights::add(std::int64_t frame_index, double now_s,
                       const std::vector<Eigen::Vector3d>& points_W) {
  const std::int64_t view = ++num_views_;
  const std::int64_t frames_since = std::max<std::int64_t>(1, frame_index - last_frame_);
  last_frame_ = frame_index;
  for (const Eigen::Vector3d& p_W : points_W) {
    Sight& sight = sights_[cell_at(p_W, cell_m_)];
    if (sight.last_view == view) continue;
    sight.num_frames += sight.last_view == view - 1 && view > 1 ? frames_since : 1;
    sight.last_view = view;
    if (sight.seen_s < 0.0 && sight.num_frames >= min_frames_) sight.seen_s = now_s;
  }
}

std::optional<double> RegionSights::seen_s(CellKey key) const {
  const auto found = sights_.find(key);
  if (found == sights_.end() || found->second.seen_s < 0.0) return std::nullopt;
  return found->second.seen_s;
}

}  // namespace kintsugi::segmenter
