#include "mapper/session/resumption.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "mapper/session/mapping_options.hpp"
#include "mapper/session/resumed_source.hpp"
#include "mapper/session/stored_frames.hpp"
#include "mapper/session/stored_stream.hpp"

namespace kintsugi::mapper {

Resumption::Resumption(SessionLog& log, const Options& options)
    : log_(log),
      max_range_m_(options.source.max_range_m),
      options_(mapping_options(options)),
      wanted_session_(options.session) {
  if (log.sessions().empty()) {
    begin_new_session();
    return;
  }
  const StoredSession& last = log.sessions().back();
  expect_same_options(options_, last.options);
  if (wanted_session_ != 0 && wanted_session_ != last.session) {
    throw std::runtime_error("--session is " + std::to_string(wanted_session_) +
                             ", the session to resume is " + std::to_string(last.session));
  }
  session_ = last.session;
  continued_ = last;
  if (!last.mapped_utimes.empty()) last_mapped_utime_ = last.mapped_utimes.back();
  StoredStream& slices = log.stream(channels::kCloudSlice, session_);
  slices.forget_behind_gap();
  StoredStream& frames = log.stream(channels::kRgbdFrame, session_);
  frames.forget_behind_gap();
  frames.forget_from(last.frame_chunks_end);  // the frame that was being stored
  spdlog::info("session {} is resumed: {} frames were mapped, {} chunks published", session_,
               last.mapped_utimes.size(), slices.next_sequence());
}

void Resumption::begin_new_session() {
  session_ = wanted_session_ != 0 ? wanted_session_ : new_session();
  continued_.reset();
  last_mapped_utime_ = -1;
  log_.begin_session(session_, options_);
}

const StoredSession* Resumption::ended_session() const {
  if (!continued_ || continued_->slice_chunks_end == 0) return nullptr;
  const std::int64_t published = log_.stream(channels::kCloudSlice, session_).next_sequence();
  return published >= continued_->slice_chunks_end ? &*continued_ : nullptr;
}

std::unique_ptr<FrameSource> Resumption::attach(std::unique_ptr<FrameSource> source) {
  if (!continued_) return source;
  if (source->frames_total() >= 0) {
    return std::make_unique<ResumedSource>(std::move(source), continued_->mapped_utimes,
                                           continued_->final_slice_begun);
  }
  if (has_all_frames()) return stored_frames_before(std::move(source));
  spdlog::warn(
      "session {} cannot go on: its camera does not give the same frames again. What it published "
      "is still served; a new session begins",
      session_);
  wanted_session_ = 0;
  begin_new_session();
  return source;
}

bool Resumption::has_all_frames() const {
  const std::int64_t stored = log_.stream(channels::kRgbdFrame, session_).next_sequence();
  return stored > 0 && stored == continued_->frame_chunks_end &&
         continued_->last_frame_utime >= last_mapped_utime_;
}

std::unique_ptr<FrameSource> Resumption::stored_frames_before(
    std::unique_ptr<FrameSource> camera) const {
  constexpr std::int64_t kShortestPause_us = 33'000;  // should the wall clock have gone back
  const std::int64_t pause_us = wall_clock_us() - continued_->last_event_utime;
  return std::make_unique<StoredThenLiveSource>(
      log_.stream(channels::kRgbdFrame, session_), continued_->frame_chunks_end, max_range_m_,
      std::move(camera), std::max(pause_us, kShortestPause_us), continued_->final_slice_begun);
}

bool Resumption::has_caught_up(std::int64_t last_utime) const {
  return last_utime >= last_mapped_utime_;
}

}  // namespace kintsugi::mapper
