#include "segmenter/session/session_map.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/stopwatch.hpp"

namespace kintsugi::segmenter {
namespace {

SliceSequencer::Done slices_in(const SegmentMap& map) {
  SliceSequencer::Done done;
  for (const SliceRecord& slice : map.cloud().slices()) {
    done.revisions[slice.slice_id] = slice.revision;
    done.has_patches = done.has_patches || slice.patch != PatchState::kNoPatch;
  }
  return done;
}

bool is_patch(const CloudSlice& slice) { return slice.kind == SliceKind::kPatch; }

/// How far a run brings the next save nearer. A batch comes several times a second, whatever the
/// number of its patches.
std::int64_t slices_to_count(const std::vector<CloudSlice>& slices) {
  const auto num_patches = std::ranges::count_if(slices, is_patch);
  return std::ssize(slices) - num_patches + (num_patches > 0 ? 1 : 0);
}

std::string text_of(const SliceGap& gap, std::int64_t map_session) {
  const std::string missing = gap.num_revisions > 0
                                  ? std::string("the newest revisions of some slices")
                                  : fmt::format("slices {} to {}", gap.first, gap.last);
  return fmt::format("{} of session {} are missing: the map continues without them", missing,
                     map_session);
}

}  // namespace

void SessionMap::Config::validate() const {
  order.validate();
  require(write_every >= 0, "write_every", write_every, ">= 0");
  require(save_every >= 0, "save_every", save_every, ">= 0");
}

SessionMap::SessionMap(const Config& config, std::unique_ptr<SegmentMap> map)
    : config_((config.validate(), config)),
      map_(std::move(map)),
      sequencer_(config.order, slices_in(*map_)),
      is_saved_(map_->cloud().slices().empty()) {
  counts_.map_session = map_->map_session();
  counts_.map_name = map_->map_name();
  counts_.received = counts_.segmented = std::ssize(map_->cloud().slices());
  count_map();
}

std::optional<std::string> SessionMap::offer(CloudSlice slice, Clock::time_point now) {
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

StepResult SessionMap::step(Clock::time_point now, Outlook outlook) {
  StepResult result;
  const std::vector<CloudSlice> slices = take_ready(now, outlook);
  if (!slices.empty()) {
    result.has_progressed = true;
    result.updates = segment(slices);
    if (auto request = save_when_due(slices_to_count(slices))) {
      result.saves.push_back(*std::move(request));
    }
  } else if (const auto gap = sequencer_.give_up_gap(now, outlook)) {
    result.has_progressed = true;
    result.warnings.push_back(text_of(*gap, map_->map_session()));
  }
  return result;
}

// The next group; with Config::coalesce all there are, the newest revision of each slice.
std::vector<CloudSlice> SessionMap::take_ready(Clock::time_point now, Outlook outlook) {
  const bool all = config_.coalesce && map_->config().mode == "batch";
  std::vector<CloudSlice> slices;
  std::map<std::int32_t, std::size_t> place_of;
  while (all || slices.empty()) {
    auto run = sequencer_.pop(now, outlook);
    if (!run) {
      break;
    }
    map_->skip_chunks(run->superseded);
    for (CloudSlice& slice : run->slices) {
      const auto [place, is_new] = place_of.try_emplace(slice.id, slices.size());
      if (is_new) {
        slices.push_back(std::move(slice));
      } else {
        slices[place->second] = std::move(slice);
      }
    }
  }
  return slices;
}

std::vector<SegmentUpdate> SessionMap::segment(const std::vector<CloudSlice>& slices) {
  const auto num_new = std::ranges::count_if(slices, [this](const CloudSlice& slice) {
    return map_->cloud().find_slice(slice.id) == nullptr;
  });
  const Stopwatch watch;
  is_saved_ = false;
  is_broken_ = true;  // in case this throws
  if (const CloudSlice* const next = sequencer_.upcoming()) {
    map_->look_ahead(*next);
  }
  std::vector<SegmentUpdate> updates = map_->add(slices);
  is_broken_ = false;
  count_run(num_new, std::ssize(slices) - num_new, watch.elapsed_ms());
  return updates;
}

std::optional<SaveRequest> SessionMap::save_when_due(std::int64_t num_slices) {
  num_since_write_ += num_slices;
  num_since_save_ += num_slices;
  const auto is_due = [](int every, std::int64_t since) { return every > 0 && since >= every; };
  if (counts_.complete || is_due(config_.write_every, num_since_write_)) {
    return save();
  }
  if (is_due(config_.save_every, num_since_save_)) {
    num_since_save_ = 0;
    return SaveRequest{map_, SaveKind::kForResume};
  }
  return std::nullopt;
}

void SessionMap::count_run(std::int64_t num_new, std::int64_t num_corrected, double run_ms) {
  counts_.segmented += num_new;
  counts_.corrected += num_corrected;
  num_timed_ += num_new + num_corrected;
  total_ms_ += run_ms;
  counts_.slice_ms = run_ms / static_cast<double>(num_new + num_corrected);
  counts_.slice_mean_ms = total_ms_ / static_cast<double>(num_timed_);
  counts_.slice_max_ms = std::max(counts_.slice_max_ms, counts_.slice_ms);
  count_map();
}

void SessionMap::count_map() {
  counts_.lag = sequencer_.num_waiting() + sequencer_.num_missing();
  counts_.missing = sequencer_.num_given_up();
  counts_.points = map_->cloud().num_live();
  counts_.rejected = map_->cloud().num_rejected();
  counts_.segments = map_->segment_ids().num_segments();
  counts_.complete = map_->is_complete();
  counts_.ended = map_->has_final_slice() && sequencer_.num_waiting() == 0;
}

std::optional<SaveRequest> SessionMap::save(bool again) {
  if (is_saved_ && !again) {
    return std::nullopt;
  }
  is_saved_ = true;
  num_since_write_ = num_since_save_ = 0;
  return SaveRequest{map_, is_broken_ ? SaveKind::kBroken : SaveKind::kCurrent};
}

}  // namespace kintsugi::segmenter
