#include "mapper/session/resumption.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "mapper/session/mapping_options.hpp"
#include "mapper/session/resumed_source.hpp"
#include "mapper/session/stored_frames.hpp"
#include "mapper/session/stored_stream.hpp"

namespace kintsugi::mapper {

Resumption::Resumption(SessionStore& store, const Config& config) : store_(store), config_(config) {
  if (store.sessions().empty()) {
    begin_run(config.session != 0 ? config.session : new_session());
  } else {
    continue_last_run();
  }
}

void Resumption::begin_run(std::int64_t session) {
  session_ = session;
  continued_.reset();
  last_mapped_utime_ = -1;
  store_.begin_session(session, config_.options);
}

void Resumption::continue_last_run() {
  const StoredSession& last = store_.sessions().back();
  const StoredSession now = decode_options(encode_options(last.session, config_.options));
  expect_same_options(now.options, last.options);  // as a log has them
  session_ = last.session;
  if (config_.session != 0 && config_.session != session_) {
    throw std::runtime_error("--session is " + std::to_string(config_.session) +
                             ", the session to resume is " + std::to_string(session_));
  }
  continued_ = last;
  if (!last.frames.mapped_utimes.empty()) last_mapped_utime_ = last.frames.mapped_utimes.back();
  // Missing chunks and the ones after them are made and added again.
  StoredStream& slices = store_.stream(channels::kCloudSlice, session_);
  slices.index().truncate_at_gap();
  store_.stream(channels::kKeyframe, session_).index().truncate_at_gap();
  ChunkIndex& frames = store_.stream(channels::kRgbdFrame, session_).index();
  frames.truncate_at_gap();
  // Drops a frame of which only a part was stored.
  frames.truncate(continued_->frame_chunks_end);
  spdlog::info("session {} is resumed: {} frames were mapped, {} chunks published", session_,
               continued_->frames.mapped_utimes.size(), slices.next_sequence());
}

bool Resumption::has_all_slices() const {
  return continued_->slice_chunks_end > 0 &&
         store_.stream(channels::kCloudSlice, session_).next_sequence() >=
             continued_->slice_chunks_end;
}

const StoredSession* Resumption::ended_session() const {
  const bool is_whole = continued_ && continued_->final_slice_begun && has_all_slices();
  return is_whole ? &*continued_ : nullptr;
}

std::unique_ptr<FrameSource> Resumption::attach(std::unique_ptr<FrameSource> source) {
  if (!continued_) return source;
  if (continued_->last_status && continued_->last_status->guests > 0) {
    return begin_anew(std::move(source), "what its guests sent cannot be repeated (--join)");
  }
  if (source->status().frames_total >= 0) {
    return std::make_unique<ResumedSource>(std::move(source), continued_->frames.mapped_utimes,
                                           continued_->final_slice_begun);
  }
  if (has_all_frames()) return stored_frames_before(std::move(source));
  return begin_anew(std::move(source), "a camera cannot repeat the frames that were mapped");
}

std::unique_ptr<FrameSource> Resumption::begin_anew(std::unique_ptr<FrameSource> source,
                                                    const std::string& why) {
  spdlog::warn(
      "session {} cannot be continued: {}. Its slices are still sent to those who ask; a new "
      "session begins",
      session_, why);
  begin_run(new_session());
  return source;
}

bool Resumption::has_all_frames() const {
  const std::int64_t stored = store_.stream(channels::kRgbdFrame, session_).next_sequence();
  return stored > 0 && stored == continued_->frame_chunks_end &&
         continued_->last_frame_utime >= last_mapped_utime_;
}

std::unique_ptr<FrameSource> Resumption::stored_frames_before(
    std::unique_ptr<FrameSource> camera) const {
  constexpr std::int64_t kShortestPause_us = 33'000;  // if the wall clock was set back
  const std::int64_t pause_us = wall_clock_us() - continued_->last_event_utime;
  return std::make_unique<StoredThenLiveSource>(
      store_.stream(channels::kRgbdFrame, session_), continued_->frame_chunks_end,
      config_.max_range_m, std::move(camera), std::max(pause_us, kShortestPause_us),
      continued_->final_slice_begun);
}

std::optional<bool> Resumption::was_fused(std::int64_t utime) const {
  if (!was_mapped(utime)) return std::nullopt;
  return !std::ranges::binary_search(continued_->frames.tracked_only_utimes, utime);
}

bool Resumption::has_caught_up(std::int64_t last_utime) const {
  return last_utime >= last_mapped_utime_;
}

}  // namespace kintsugi::mapper
