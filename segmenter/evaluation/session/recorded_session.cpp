#include "segmenter/evaluation/session/recorded_session.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace kintsugi::segmenter {
std::vector<const CloudSlice*> RecordedSession::newest_slices() const {
  std::map<std::int32_t, const CloudSlice*> by_id;
  for (const auto& step : steps) {
    for (const CloudSlice& slice : step.slices) by_id[slice.id] = &slice;
  }
  std::vector<const CloudSlice*> slices;
  slices.reserve(by_id.size());
  for (const auto& [id, slice] : by_id) slices.push_back(slice);
  return slices;
}

std::int64_t RecordedSession::num_points() const {
  std::int64_t count = 0;
  for (const CloudSlice* slice : newest_slices()) count += std::ssize(slice->points_W);
  return count;
}

std::int64_t ready_us(const SliceGroup& step) {
  return std::ranges::max_element(step.slices, {}, &CloudSlice::utime)->utime;
}

}  // namespace kintsugi::segmenter
