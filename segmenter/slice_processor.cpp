#include "segmenter/slice_processor.hpp"

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
  const std::string name = name_of(slice);
  switch (sequencer_->offer(std::move(slice), now)) {
    case SliceSequencer::Verdict::kTaken:
      ++counts_.received;
      break;
    case SliceSequencer::Verdict::kReplaced:
    case SliceSequencer::Verdict::kDuplicate:
      break;
    case SliceSequencer::Verdict::kRevision:
      ++counts_.dropped;
      outputs_.warn(name +
                    " came again with a correction after it was segmented: "
                    "corrections are not supported yet, it is dropped");
      break;
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
  total_ms_ = 0.0;
}

void SliceProcessor::end_session(Clock::time_point now) {
  finish(now);
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
  const std::vector<CloudSlice> slices = take_ready(now);
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

std::vector<CloudSlice> SliceProcessor::take_ready(Clock::time_point now) {
  const bool all = config_.coalesce && config_.map.mode == "batch";
  std::vector<CloudSlice> slices;
  while (all || slices.empty()) {
    auto slice = sequencer_->pop(now);
    if (!slice) {
      break;
    }
    slices.push_back(std::move(*slice));
  }
  return slices;
}

void SliceProcessor::segment(const std::vector<CloudSlice>& slices) {
  const auto start = Clock::now();
  std::vector<SegmentUpdate> updates = map_->add(slices);
  const std::chrono::duration<double, std::milli> run = Clock::now() - start;
  count_run(slices, run.count());
  is_saved_ = false;
  num_since_save_ += static_cast<std::int64_t>(slices.size());
  for (SegmentUpdate& update : updates) {
    outputs_.publish(std::move(update));
  }
  const bool is_due = config_.write_every > 0 && num_since_save_ >= config_.write_every;
  if (is_due || counts_.complete) {
    save();
  }
}

void SliceProcessor::count_run(const std::vector<CloudSlice>& slices, double run_ms) {
  const auto num_slices = static_cast<std::int64_t>(slices.size());
  counts_.segmented += num_slices;
  counts_.lag = sequencer_->num_waiting() + sequencer_->num_missing();
  counts_.missing = sequencer_->num_given_up();
  counts_.points = map_->cloud().size();
  counts_.rejected = map_->cloud().num_rejected();
  counts_.segments = map_->segment_ids().num_segments();
  counts_.complete = map_->is_complete();
  counts_.ended = map_->has_final_slice() && sequencer_->num_waiting() == 0;
  total_ms_ += run_ms;
  counts_.slice_ms = run_ms / static_cast<double>(num_slices);
  counts_.slice_mean_ms = total_ms_ / static_cast<double>(counts_.segmented);
  counts_.slice_max_ms = std::max(counts_.slice_max_ms, counts_.slice_ms);
}

void SliceProcessor::save() {
  if (map_ && !is_saved_) {
    num_since_save_ = 0;
    is_saved_ = outputs_.save(*map_, Save::kCurrent);
  }
}

}  // namespace kintsugi::segmenter
