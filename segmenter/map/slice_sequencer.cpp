#include "segmenter/map/slice_sequencer.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::segmenter {
namespace {

void check_positive(const char* field, std::chrono::milliseconds value) {
  require(value.count() > 0, field, std::to_string(value.count()) + " ms", "> 0");
}

}  // namespace

void SliceSequencer::Config::validate() const {
  check_positive("gap_timeout", gap_timeout);
  check_positive("correction_quiet", correction_quiet);
}

SliceSequencer::SliceSequencer(const Config& config, Revisions done)
    : config_(config), known_(std::move(done)) {
  config_.validate();
  if (!known_.empty()) {
    next_id_ = end_id_ = std::int64_t{known_.rbegin()->first} + 1;
  }
}

SliceSequencer::Verdict SliceSequencer::offer(CloudSlice slice, Clock::time_point now) {
  if (known_.contains(slice.id)) {
    return correct(std::move(slice), now);
  }
  end_id_ = std::max(end_id_, std::int64_t{slice.id} + 1);
  if (slice.id <= next_id_) {
    waiting_bytes_ += bytes_of(slice);
    make_ready(std::move(slice));
    take_turns();
    last_progress_ = now;
    return Verdict::kTaken;
  }
  const auto [place, is_new] = waiting_.try_emplace(slice.id);
  waiting_bytes_ += is_new ? sizeof(CloudSlice) : 0;
  if (!is_new && slice.revision <= place->second.revision) {
    return Verdict::kDuplicate;
  }
  if (waiting_.size() == 1) {
    last_progress_ = now;
  }
  put(place->second, std::move(slice));
  return is_new ? Verdict::kTaken : Verdict::kReplaced;
}

SliceSequencer::Verdict SliceSequencer::correct(CloudSlice slice, Clock::time_point now) {
  std::int32_t& known = known_.at(slice.id);
  if (slice.revision <= known) {
    return Verdict::kDuplicate;
  }
  known = slice.revision;
  last_correction_ = now;
  if (ready_.empty() || !ready_.back().is_correction) {
    ready_.push_back({{}, true});
    first_correction_ = now;
  }
  auto& slices = ready_.back().slices;
  const auto place = std::ranges::lower_bound(slices, slice.id, {}, &CloudSlice::id);
  if (place != slices.end() && place->id == slice.id) {
    put(*place, std::move(slice));
  } else {
    waiting_bytes_ += bytes_of(slice);
    slices.insert(place, std::move(slice));
    ++num_ready_;
  }
  return Verdict::kCorrected;
}

// Replaces a waiting slice.
void SliceSequencer::put(CloudSlice& place, CloudSlice slice) {
  waiting_bytes_ += bytes_of(slice);
  waiting_bytes_ -= bytes_of(place);
  place = std::move(slice);
}

void SliceSequencer::make_ready(CloudSlice slice) {
  known_.emplace(slice.id, slice.revision);
  next_id_ = std::max(next_id_, std::int64_t{slice.id} + 1);
  ready_.push_back({});
  ready_.back().slices.push_back(std::move(slice));
  ++num_ready_;
}

void SliceSequencer::take_turns() {
  while (!waiting_.empty() && waiting_.begin()->first == next_id_) {
    make_ready(std::move(waiting_.extract(waiting_.begin()).mapped()));
  }
}

std::optional<SliceGroup> SliceSequencer::pop(Clock::time_point now, Outlook outlook) {
  if (ready_.empty() || (outlook != Outlook::kEnded && may_grow(now))) {
    return std::nullopt;
  }
  SliceGroup group = std::move(ready_.front());
  ready_.pop_front();
  num_ready_ -= std::ssize(group.slices);
  for (const CloudSlice& slice : group.slices) {
    waiting_bytes_ -= bytes_of(slice);
  }
  if (!group.is_correction) {
    last_progress_ = now;
  }
  return group;
}

// Whether the first group in ready_ waits for more corrections.
bool SliceSequencer::may_grow(Clock::time_point now) const {
  return ready_.size() == 1 && ready_.front().is_correction &&
         now - last_correction_ < config_.correction_quiet &&
         now - first_correction_ < config_.gap_timeout;
}

std::optional<SliceGap> SliceSequencer::give_up_gap(Clock::time_point now, Outlook outlook) {
  if (waiting_.empty() || !ready_.empty() || outlook == Outlook::kLive) {
    return std::nullopt;
  }
  if (outlook == Outlook::kSilent && now - last_progress_ < config_.gap_timeout) {
    return std::nullopt;
  }
  const SliceGap gap{static_cast<std::int32_t>(next_id_), waiting_.begin()->first - 1};
  next_id_ = std::int64_t{gap.last} + 1;
  take_turns();
  return gap;
}

std::int64_t SliceSequencer::num_waiting() const { return num_ready_ + std::ssize(waiting_); }

std::int64_t SliceSequencer::num_missing() const {
  return end_id_ - static_cast<std::int64_t>(known_.size() + waiting_.size());
}

std::int64_t SliceSequencer::num_given_up() const {
  return next_id_ - static_cast<std::int64_t>(known_.size());
}

}  // namespace kintsugi::segmenter
