#include "tests/fuzz/changing_cloud.hpp"

#include <algorithm>
#include <set>

namespace kintsugi::segmenter::fuzz {

CloudChange ChangingCloud::apply(const Step& step) {
  std::set<std::int32_t> touched;
  const auto put = [&](PoolIndex i, bool in) {
    if (is_in_[i] == in) return;
    is_in_[i] = in;
    touched.insert(static_cast<std::int32_t>(i / slice_points_));
  };
  for (const PoolIndex i : step.remove) put(i, false);
  for (const PoolIndex i : step.add) put(i, true);
  for (const std::int32_t slice_id : touched) renew_slice(slice_id);
  return cloud_.take_change();
}

void ChangingCloud::renew_slice(std::int32_t slice_id) {
  std::vector<CloudPoint> points_W;
  const std::size_t first = static_cast<std::size_t>(slice_id) * slice_points_;
  const std::size_t last = std::min(first + slice_points_, pool_.size());
  for (std::size_t i = first; i < last; ++i) {
    if (is_in_[i]) points_W.push_back(pool_[i]);
  }
  if (cloud_.find_slice(slice_id) == nullptr) {
    cloud_.add_slice(slice_id, points_W);
  } else {
    cloud_.replace_slice(slice_id, points_W);
  }
}

std::vector<PointIndex> ChangingCloud::live() const {
  std::vector<PointIndex> live;
  for (const SliceRecord& slice : cloud_.slices()) {
    for (PointIndex k = 0; k < slice.count; ++k) live.push_back(slice.first + k);
  }
  std::ranges::sort(live);
  return live;
}

}  // namespace kintsugi::segmenter::fuzz
