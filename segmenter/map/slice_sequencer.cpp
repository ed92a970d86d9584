#include "segmenter/map/slice_sequencer.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace kintsugi::segmenter {

void SliceSequencer::Config::validate() const {
  if (gap_timeout.count() <= 0) {
    throw std::invalid_argument("gap_timeout is " + std::to_string(gap_timeout.count()) +
                                " ms, must be > 0");
  }
}

SliceSequencer::SliceSequencer(const Config& config) : config_(config) { config_.validate(); }

SliceSequencer::Verdict SliceSequencer::offer(CloudSlice slice, Clock::time_point now) {
  if (const auto done = handed_on_.find(slice.id); done != handed_on_.end()) {
    return slice.revision > done->second ? Verdict::kRevision : Verdict::kDuplicate;
  }
  const auto [place, is_new] = waiting_.try_emplace(slice.id);
  if (!is_new && slice.revision <= place->second.revision) {
    return Verdict::kDuplicate;
  }
  if (waiting_.size() == 1) {
    last_progress_ = now;
  }
  end_id_ = std::max(end_id_, std::int64_t{slice.id} + 1);
  place->second = std::move(slice);
  return is_new ? Verdict::kTaken : Verdict::kReplaced;
}

std::optional<CloudSlice> SliceSequencer::pop(Clock::time_point now) {
  if (waiting_.empty() || waiting_.begin()->first > next_id_) {
    return std::nullopt;
  }
  CloudSlice slice = std::move(waiting_.begin()->second);
  waiting_.erase(waiting_.begin());
  handed_on_.emplace(slice.id, slice.revision);
  next_id_ = std::max(next_id_, std::int64_t{slice.id} + 1);
  last_progress_ = now;
  return slice;
}

std::optional<SliceGap> SliceSequencer::give_up_gap(Clock::time_point now, bool stream_has_ended) {
  if (waiting_.empty() || waiting_.begin()->first <= next_id_) {
    return std::nullopt;
  }
  if (!stream_has_ended && now - last_progress_ < config_.gap_timeout) {
    return std::nullopt;
  }
  const SliceGap gap{static_cast<std::int32_t>(next_id_), waiting_.begin()->first - 1};
  next_id_ = std::int64_t{gap.last} + 1;
  return gap;
}

std::int64_t SliceSequencer::num_missing() const {
  return end_id_ - static_cast<std::int64_t>(handed_on_.size() + waiting_.size());
}

std::int64_t SliceSequencer::num_given_up() const {
  const auto num_late = std::count_if(waiting_.begin(), waiting_.end(),
                                      [&](const auto& entry) { return entry.first < next_id_; });
  return next_id_ - static_cast<std::int64_t>(handed_on_.size()) - num_late;
}

}  // namespace kintsugi::segmenter
