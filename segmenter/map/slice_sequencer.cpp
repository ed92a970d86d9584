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

SliceSequencer::SliceSequencer(const Config& config, Done done)
    : config_(config), known_(std::move(done.revisions)) {
  config_.validate();
  for (const auto& [id, revision] : known_) revision_sum_ += revision;
  if (!known_.empty()) end_id_ = std::int64_t{known_.rbegin()->first} + 1;
  if (done.has_patches) {
    skip_known();
  } else {
    next_id_ = end_id_;
    num_given_up_ = end_id_ - std::ssize(known_);
  }
}

SliceSequencer::Verdict SliceSequencer::offer(CloudSlice slice, Clock::time_point now) {
  const auto known = known_.find(slice.id);
  if (known != known_.end() && slice.revision <= known->second) {
    supersede(slice, ready_.empty() ? superseded_ : ready_.back().superseded);
    return Verdict::kDuplicate;
  }
  end_id_ = std::max(end_id_, std::int64_t{slice.id} + 1);
  if (slice.kind == SliceKind::kPatch && !waiting_.contains(slice.id)) {
    return take_patch(std::move(slice), now);
  }
  if (slice.kind == SliceKind::kCorrection && known == known_.end()) {
    return take_motions(std::move(slice));
  }
  return known != known_.end() ? correct(std::move(slice), now) : wait(std::move(slice), now);
}

SliceSequencer::Verdict SliceSequencer::take_patch(CloudSlice slice, Clock::time_point now) {
  const bool is_new = !known_.contains(slice.id);
  const bool is_late = slice.utime <= last_end_utime_;
  const bool ends_batch = slice.ends_batch;
  if (is_late) {
    ready_.push_back({.kind = Kind::kPatches});
  } else if (ends_batch) {
    last_end_utime_ = slice.utime;
  }
  Group& group = is_late ? ready_.back() : open_group(Kind::kPatches, now);
  learn(slice);
  put(group, std::move(slice));
  group.is_closed = is_late || ends_batch;
  take_turns();
  return is_new ? Verdict::kTaken : Verdict::kCorrected;
}

SliceSequencer::Verdict SliceSequencer::take_motions(CloudSlice slice) {
  if (!ready_.empty()) ready_.back().is_closed = true;
  ready_.push_back({.kind = Kind::kMotions});
  learn(slice);
  put(ready_.back(), std::move(slice));
  take_turns();
  return Verdict::kTaken;
}

SliceSequencer::Verdict SliceSequencer::correct(CloudSlice slice, Clock::time_point now) {
  learn(slice);
  put(open_group(Kind::kCorrections, now), std::move(slice));
  take_turns();
  return Verdict::kCorrected;
}

/// Keeps a slice whose turn may not have come.
SliceSequencer::Verdict SliceSequencer::wait(CloudSlice slice, Clock::time_point now) {
  const auto [place, is_new] = waiting_.try_emplace(slice.id);
  if (!is_new) {
    if (slice.revision <= place->second.revision) return Verdict::kDuplicate;
    drop(place->second);
  }
  const bool is_final = slice.kind == SliceKind::kFinal;
  const bool is_turn = slice.id <= next_id_;
  if (is_final) last_end_utime_ = std::max(last_end_utime_, slice.utime);
  if (is_final && !ready_.empty() && ready_.back().kind == Kind::kPatches) {
    ready_.back().is_closed = true;
  }
  if (is_turn || waiting_.size() == 1) last_progress_ = now;
  waiting_bytes_ += bytes_of(slice);
  place->second = std::move(slice);
  take_turns();
  return is_new ? Verdict::kTaken : Verdict::kReplaced;
}

/// The last group if it can still grow, else a new one.
SliceSequencer::Group& SliceSequencer::open_group(Kind kind, Clock::time_point now) {
  if (ready_.empty() || ready_.back().kind != kind || ready_.back().is_closed) {
    ready_.push_back({.kind = kind, .is_closed = false});
    first_arrival_ = now;
  }
  last_arrival_ = now;
  return ready_.back();
}

void SliceSequencer::put(Group& group, CloudSlice slice) {
  waiting_bytes_ += bytes_of(slice);
  const auto [place, is_new] = group.slices.try_emplace(slice.id);
  if (is_new) {
    ++num_ready_;
  } else {
    drop(place->second);
    supersede(place->second, group.superseded);
  }
  place->second = std::move(slice);
}

/// A waiting slice is replaced by another revision.
void SliceSequencer::drop(const CloudSlice& slice) { waiting_bytes_ -= bytes_of(slice); }

void SliceSequencer::supersede(const CloudSlice& slice,
                               std::vector<SequenceRange>& superseded) const {
  if (slice.num_chunks == 0) return;
  superseded.push_back({slice.sequence, slice.sequence + slice.num_chunks - 1});
}

void SliceSequencer::learn(const CloudSlice& slice) {
  const auto [known, is_new] = known_.try_emplace(slice.id, 0);
  revision_sum_ += slice.revision - known->second;
  known->second = slice.revision;
  if (is_new && slice.id < next_id_) --num_given_up_;
  skip_known();
}

void SliceSequencer::skip_known() {
  for (auto known = known_.find(static_cast<std::int32_t>(next_id_));
       known != known_.end() && known->first == next_id_; ++known) {
    ++next_id_;
  }
}

void SliceSequencer::make_ready(CloudSlice slice) {
  learn(slice);
  if (!ready_.empty()) ready_.back().is_closed = true;
  ready_.push_back({});
  ready_.back().slices.emplace(slice.id, std::move(slice));
  ++num_ready_;
}

void SliceSequencer::take_turns() {
  while (!waiting_.empty() && waiting_.begin()->first <= next_id_) {
    if (num_revisions_missing(waiting_.begin()->second) > 0) return;
    make_ready(std::move(waiting_.extract(waiting_.begin()).mapped()));
  }
}

/// How much the sum of the known revisions lacks, if this is the final slice.
std::int64_t SliceSequencer::num_revisions_missing(const CloudSlice& slice) const {
  if (slice.kind != SliceKind::kFinal || slice.revision_sum <= given_up_revision_sum_) return 0;
  return std::max<std::int64_t>(slice.revision_sum - revision_sum_ - slice.revision, 0);
}

std::optional<SliceGroup> SliceSequencer::pop(Clock::time_point now, Outlook outlook) {
  if (ready_.empty() || (outlook != Outlook::kEnded && may_grow(ready_.front(), now))) {
    return std::nullopt;
  }
  Group group = std::move(ready_.front());
  ready_.pop_front();
  if (config_.is_live && group.kind == Kind::kPatches) merge_batches(group);
  SliceGroup result;
  result.is_correction = group.kind == Kind::kCorrections;
  result.superseded = std::exchange(superseded_, {});
  result.superseded.insert(result.superseded.end(), group.superseded.begin(),
                           group.superseded.end());
  result.slices.reserve(group.slices.size());
  num_ready_ -= std::ssize(group.slices);
  for (auto& [id, slice] : group.slices) {
    waiting_bytes_ -= bytes_of(slice);
    result.slices.push_back(std::move(slice));
  }
  if (!result.is_correction) last_progress_ = now;
  return result;
}

/// Adds the complete batches that come next.
void SliceSequencer::merge_batches(Group& group) {
  while (!ready_.empty() && ready_.front().kind == Kind::kPatches && ready_.front().is_closed) {
    Group& next = ready_.front();
    for (auto& [id, slice] : next.slices) {
      --num_ready_;
      waiting_bytes_ -= bytes_of(slice);
      put(group, std::move(slice));
    }
    group.superseded.insert(group.superseded.end(), next.superseded.begin(), next.superseded.end());
    ready_.pop_front();
  }
}

/// Whether the group, the first of ready_, waits for more.
bool SliceSequencer::may_grow(const Group& group, Clock::time_point now) const {
  if (group.is_closed || ready_.size() > 1) return false;
  if (group.kind == Kind::kPatches && !config_.is_live) {
    return now - std::max(last_arrival_, last_progress_) < config_.gap_timeout;
  }
  return now - last_arrival_ < config_.correction_quiet &&
         now - first_arrival_ < config_.gap_timeout;
}

const CloudSlice* SliceSequencer::upcoming() const {
  if (ready_.empty() || ready_.front().kind != Kind::kNewSlice) return nullptr;
  return &ready_.front().slices.begin()->second;
}

bool SliceSequencer::is_in_batch() const {
  return ready_.size() == 1 && ready_.front().kind == Kind::kPatches && !ready_.front().is_closed;
}

std::optional<SliceGap> SliceSequencer::give_up_gap(Clock::time_point now, Outlook outlook) {
  if (waiting_.empty() || !ready_.empty() || outlook == Outlook::kLive) {
    return std::nullopt;
  }
  if (outlook == Outlook::kSilent && now - last_progress_ < config_.gap_timeout) {
    return std::nullopt;
  }
  const auto& [id, slice] = *waiting_.begin();
  SliceGap gap{static_cast<std::int32_t>(next_id_), id - 1};
  if (id <= next_id_) {
    gap.num_revisions = num_revisions_missing(slice);
    given_up_revision_sum_ = slice.revision_sum;
  } else {
    const auto known = known_.upper_bound(gap.first);
    if (known != known_.end()) gap.last = std::min(gap.last, known->first - 1);
    num_given_up_ += std::int64_t{gap.last} - gap.first + 1;
    next_id_ = std::int64_t{gap.last} + 1;
    skip_known();
  }
  take_turns();
  return gap;
}

std::int64_t SliceSequencer::num_waiting() const { return num_ready_ + std::ssize(waiting_); }

std::int64_t SliceSequencer::num_missing() const {
  return end_id_ - static_cast<std::int64_t>(known_.size() + waiting_.size());
}

std::int64_t SliceSequencer::num_given_up() const {
  return num_given_up_ == 0 && revision_sum_ < given_up_revision_sum_ ? 1 : num_given_up_;
}

}  // namespace kintsugi::segmenter
