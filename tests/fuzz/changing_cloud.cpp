#include "tests/fuzz/changing_cloud.hpp"

#include <algorithm>

namespace kintsugi::segmenter::fuzz {

CloudChange ChangingCloud::apply(const Step& step) {
  CloudChange change;
  for (const PoolIndex i : step.remove) {
    if (!index_[i]) continue;
    change.removed.push_back(*index_[i]);
    index_[i].reset();
  }
  for (const PoolIndex i : step.add) {
    if (index_[i]) continue;
    const SliceRecord& slice =
        cloud_.add_slice(static_cast<std::int32_t>(cloud_.slices().size()), {&pool_[i], 1});
    index_[i] = slice.first;
    pool_index_.push_back(i);
    change.added.push_back(slice.first);
  }
  cloud_.take_change();
  std::ranges::sort(change.removed);
  std::ranges::sort(change.added);
  return change;
}

std::vector<PointIndex> ChangingCloud::live() const {
  std::vector<PointIndex> live;
  for (const auto& index : index_) {
    if (index) live.push_back(*index);
  }
  std::ranges::sort(live);
  return live;
}

}  // namespace kintsugi::segmenter::fuzz
