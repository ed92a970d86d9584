#include "segmenter/process/slice_processor.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kintsugi::segmenter {
namespace {

std::string name_of(const CloudSlice& slice) {
  return "slice " + std::to_string(slice.id) + " of session " + std::to_string(slice.session);
}

}  // namespace

void SliceProcessor::Config::validate() const {
  map.validate();
  order.validate();
  if (write_every < 0) {
    throw std::invalid_argument("write_every is " + std::to_string(write_every) + ", must be >= 0");
  }
}

SliceProcessor::SliceProcessor(const Config& config, std::int64_t session, Outputs outputs)
    : config_(config), session_(session), outputs_(std::move(outputs)) {
  config_.validate();
}

void SliceProcessor::offer(CloudSlice slice, Clock::time_point now) {
  if (!is_wanted(slice)) {
    return;
  }
  if (map_ && slice.session != map_->map_session()) {
    end_session(now);
  }
  if (!map_) {
    begin_session(slice);
  }
  if (static_cast<double>(slice.resolution_m) != map_->config().engine.resolution_m) {
    drop(slice, "its resolution differs from the map's");
    return;
  }
  if (sequencer_->offer(std::move(slice), now) == SliceSequencer::Verdict::kTaken) {
    ++counts_.received;
  }
  counts_.lag = sequencer_->num_waiting() + sequencer_->num_missing();
}

bool SliceProcessor::is_wanted(const CloudSlice& slice) {
  if (!config_.map_name.empty() && slice.map_name != config_.map_name) {
    return false;
  }
  if (ended_sessions_.contains(slice.session)) {
    drop(slice, "its session has ended; two mappers at a time need --map-name");
    return false;
  }
  return true;
}

void SliceProcessor::drop(const CloudSlice& slice, const std::string& why) {
  ++counts_.dropped;
  outputs_.warn(name_of(slice) + " is dropped: " + why);
}

void SliceProcessor::begin_session(const CloudSlice& first) {
  map_ = std::make_unique<SegmentMap>(config_.map, session_, first);
  sequencer_.emplace(config_.order);
  const std::int64_t dropped = counts_.dropped;
  counts_ = {};
  counts_.dropped = dropped;
  counts_.map_session = first.session;
  counts_.map_name = first.map_name;
  is_saved_ = true;
  num_since_save_ = 0;
  num_timed_ = 0;
  total_ms_ = 0.0;
}

void SliceProcessor::resume(std::unique_ptr<SegmentMap> map) {
  map_ = std::move(map);
  SliceSequencer::Revisions done;
  for (const SliceRecord& slice : map_->cloud().slices()) {
    done[slice.slice_id] = slice.revision;
  }
  counts_.map_session = map_->map_session();
  counts_.map_name = map_->map_name();
  counts_.received = counts_.segmented = std::ssize(done);
  sequencer_.emplace(config_.order, std::move(done));
  count_map();
  for (SegmentUpdate& update : map_->describe()) {
    outputs_.publish(std::move(update));
  }
}

void SliceProcessor::end_session(Clock::time_point now) {
  finish(now);
  outputs_.warn("session " + std::to_string(map_->map_session()) +
                " has ended: a slice of another one came");
  outputs_.save(*map_, Save::kSessionEnded);
  ended_sessions_.insert(map_->map_session());
  sequencer_.reset();
  map_.reset();
}

bool SliceProcessor::step(Clock::time_point now) { return step(now, false); }

void SliceProcessor::finish(Clock::time_point now) {
  while (step(now, true)) {
  }
}

bool SliceProcessor::step(Clock::time_point now, bool stream_has_ended) {
  if (!map_) {
    return false;
  }
  const std::vector<CloudSlice> slices = take_ready(now, stream_has_ended);
  if (!slices.empty()) {
    segment(slices);
    return true;
  }
  const auto gap = sequencer_->give_up_gap(now, stream_has_ended);
  if (gap) {
    outputs_.warn("slices " + std::to_string(gap->first) + " to " + std::to_string(gap->last) +
                  " of session " + std::to_string(map_->map_session()) +
                  " are missing: going on without them");
  }
  return gap.has_value();
}

// The next run; with Config::coalesce all there are, the newest revision of each slice.
std::vector<CloudSlice> SliceProcessor::take_ready(Clock::time_point now, bool stream_has_ended) {
  const bool all = config_.coalesce && config_.map.mode == "batch";
  std::vector<CloudSlice> slices;
  while (all || slices.empty()) {
    auto run = sequencer_->pop(now, stream_has_ended);
    if (!run) {
      break;
    }
    for (CloudSlice& slice : run->slices) {
      const auto earlier = std::ranges::find(slices, slice.id, &CloudSlice::id);
      if (earlier == slices.end()) {
        slices.push_back(std::move(slice));
      } else {
        *earlier = std::move(slice);
      }
    }
  }
  return slices;
}

void SliceProcessor::segment(const std::vector<CloudSlice>& slices) {
  const auto num_slices = std::ssize(slices);
  const auto num_new = std::ranges::count_if(slices, [this](const CloudSlice& slice) {
    return map_->cloud().find_slice(slice.id) == nullptr;
  });
  const auto start = Clock::now();
  is_saved_ = false;
  is_broken_ = true;  // should this throw
  if (const CloudSlice* const next = sequencer_->upcoming()) {
    map_->look_ahead(*next);
  }
  std::vector<SegmentUpdate> updates = map_->add(slices);
  is_broken_ = false;
  const std::chrono::duration<double, std::milli> run = Clock::now() - start;
  count_run(num_new, num_slices - num_new, run.count());
  for (SegmentUpdate& update : updates) {
    outputs_.publish(std::move(update));
  }
  num_since_save_ += num_slices;
  const bool is_due = config_.write_every > 0 && num_since_save_ >= config_.write_every;
  if (is_due || counts_.complete) {
    save();
  }
}

void SliceProcessor::count_run(std::int64_t num_new, std::int64_t num_corrected, double run_ms) {
  counts_.segmented += num_new;
  counts_.corrected += num_corrected;
  num_timed_ += num_new + num_corrected;
  total_ms_ += run_ms;
  counts_.slice_ms = run_ms / static_cast<double>(num_new + num_corrected);
  counts_.slice_mean_ms = total_ms_ / static_cast<double>(num_timed_);
  counts_.slice_max_ms = std::max(counts_.slice_max_ms, counts_.slice_ms);
  count_map();
}

void SliceProcessor::count_map() {
  counts_.lag = sequencer_->num_waiting() + sequencer_->num_missing();
  counts_.missing = sequencer_->num_given_up();
  counts_.points = map_->cloud().num_live();
  counts_.rejected = map_->cloud().num_rejected();
  counts_.segments = map_->segment_ids().num_segments();
  counts_.complete = map_->is_complete();
  counts_.ended = map_->has_final_slice() && sequencer_->num_waiting() == 0;
}

void SliceProcessor::save(bool again) {
  if (map_ && (again || !is_saved_)) {
    is_saved_ = true;
    num_since_save_ = 0;
    outputs_.save(*map_, is_broken_ ? Save::kBroken : Save::kCurrent);
  }
}

}  // namespace kintsugi::segmenter
