#include "segmenter/process/slice_processor.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kintsugi::segmenter {
namespace {

void require_not_negative(const char* field, int value) {
  if (value < 0) {
    throw std::invalid_argument(std::string(field) + " is " + std::to_string(value) +
                                ", must be >= 0");
  }
}

SliceSequencer::Revisions revisions_in(const SegmentMap& map) {
  SliceSequencer::Revisions revisions;
  for (const SliceRecord& slice : map.cloud().slices()) {
    revisions[slice.slice_id] = slice.revision;
  }
  return revisions;
}

}  // namespace

void SliceProcessor::Config::validate() const {
  order.validate();
  require_not_negative("write_every", write_every);
  require_not_negative("save_every", save_every);
}

SliceProcessor::SliceProcessor(const Config& config, std::unique_ptr<SegmentMap> map,
                               Outputs outputs)
    : config_((config.validate(), config)),
      outputs_(std::move(outputs)),
      map_(std::move(map)),
      sequencer_(config.order, revisions_in(*map_)) {
  counts_.map_session = map_->map_session();
  counts_.map_name = map_->map_name();
  counts_.received = counts_.segmented = std::ssize(map_->cloud().slices());
  count_map();
}

std::optional<std::string> SliceProcessor::offer(CloudSlice slice, Clock::time_point now) {
  if (slice.map_name != map_->map_name()) {
    return "its map is '" + slice.map_name + "', its session's map '" + map_->map_name() + "'";
  }
  if (static_cast<double>(slice.resolution_m) != map_->config().engine.resolution_m) {
    return "its resolution differs from the map's";
  }
  if (sequencer_.offer(std::move(slice), now) == SliceSequencer::Verdict::kTaken) {
    ++counts_.received;
  }
  counts_.lag = sequencer_.num_waiting() + sequencer_.num_missing();
  return std::nullopt;
}

void SliceProcessor::finish(Clock::time_point now) {
  while (step(now, Outlook::kEnded)) {
  }
}

bool SliceProcessor::step(Clock::time_point now, Outlook outlook) {
  const std::vector<CloudSlice> slices = take_ready(now, outlook);
  if (!slices.empty()) {
    segment(slices);
    return true;
  }
  const auto gap = sequencer_.give_up_gap(now, outlook);
  if (gap) {
    outputs_.warn("slices " + std::to_string(gap->first) + " to " + std::to_string(gap->last) +
                  " of session " + std::to_string(map_->map_session()) +
                  " are missing: going on without them");
  }
  return gap.has_value();
}

// The next run; with Config::coalesce all there are, the newest revision of each slice.
std::vector<CloudSlice> SliceProcessor::take_ready(Clock::time_point now, Outlook outlook) {
  const bool all = config_.coalesce && map_->config().mode == "batch";
  std::vector<CloudSlice> slices;
  while (all || slices.empty()) {
    auto run = sequencer_.pop(now, outlook);
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
  const auto start = std::chrono::steady_clock::now();
  is_saved_ = false;
  is_broken_ = true;  // should this throw
  if (const CloudSlice* const next = sequencer_.upcoming()) {
    map_->look_ahead(*next);
  }
  std::vector<SegmentUpdate> updates = map_->add(slices);
  is_broken_ = false;
  const std::chrono::duration<double, std::milli> run = std::chrono::steady_clock::now() - start;
  count_run(num_new, num_slices - num_new, run.count());
  for (SegmentUpdate& update : updates) {
    outputs_.publish(std::move(update));
  }
  save_when_due(num_slices);
}

void SliceProcessor::save_when_due(std::int64_t num_slices) {
  num_since_write_ += num_slices;
  num_since_save_ += num_slices;
  const auto is_due = [](int every, std::int64_t since) { return every > 0 && since >= every; };
  if (counts_.complete || is_due(config_.write_every, num_since_write_)) {
    save();
  } else if (is_due(config_.save_every, num_since_save_)) {
    num_since_save_ = 0;
    outputs_.save(*map_, Save::kToGoOn);
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
  counts_.lag = sequencer_.num_waiting() + sequencer_.num_missing();
  counts_.missing = sequencer_.num_given_up();
  counts_.points = map_->cloud().num_live();
  counts_.rejected = map_->cloud().num_rejected();
  counts_.segments = map_->segment_ids().num_segments();
  counts_.complete = map_->is_complete();
  counts_.ended = map_->has_final_slice() && sequencer_.num_waiting() == 0;
}

void SliceProcessor::save(bool again) {
  if (again || !is_saved_) {
    is_saved_ = true;
    num_since_write_ = num_since_save_ = 0;
    outputs_.save(*map_, is_broken_ ? Save::kBroken : Save::kCurrent);
  }
}

}  // namespace kintsugi::segmenter
