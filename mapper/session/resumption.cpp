#include "mapper/session/resumption.hpp"

#include <algorithm>
#include <iterator>
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

Resumption::Resumption(SessionStore& store, const Config& config) : store_(store), config_(config) {
  if (store.sessions().empty()) {
    begin_run(config.session != 0 ? config.session : new_session());
  } else {
    continue_last_run();
  }
}

void Resumption::begin_run(std::int64_t session) {
  session_ = session;
  continued_.clear();
  last_mapped_utime_ = -1;
  store_.begin_session(session, config_.options);
}

void Resumption::continue_last_run() {
  const StoredSession& last = store_.sessions().back();
  expect_same_options(config_.options, last.options);
  session_ = last.session - last.part;
  if (config_.session != 0 && config_.session != session_) {
    throw std::runtime_error("--session is " + std::to_string(config_.session) +
                             ", the session to resume is " + std::to_string(session_));
  }
  const auto is_part = [&](const StoredSession& other) {
    return other.session == session_ + other.part && other.part <= last.part;
  };
  std::ranges::copy_if(store_.sessions(), std::back_inserter(continued_), is_part);
  if (std::ssize(continued_) != last.part + 1) {
    throw std::runtime_error("session " + std::to_string(last.session) + " is part " +
                             std::to_string(last.part) + " of a run, the log has only " +
                             std::to_string(std::ssize(continued_) - 1) + " parts before it");
  }
  const std::vector<std::int64_t> utimes = mapped_utimes();
  if (!utimes.empty()) last_mapped_utime_ = utimes.back();
  // Missing chunks and the ones after them are made and added again.
  std::int64_t num_chunks = 0;
  for (const StoredSession& part : continued_) {
    StoredStream& slices = store_.stream(channels::kCloudSlice, part.session);
    slices.index().truncate_at_gap();
    num_chunks += slices.next_sequence();
  }
  ChunkIndex& frames = store_.stream(channels::kRgbdFrame, session_).index();
  frames.truncate_at_gap();
  // Drops a frame of which only a part was stored.
  frames.truncate(continued_.front().frame_chunks_end);
  spdlog::info("session {} is resumed: {} frames were mapped, {} chunks published", session_,
               utimes.size(), num_chunks);
}

std::int64_t Resumption::begin_part(int part) {
  const std::int64_t session = session_ + part;
  if (part < std::ssize(continued_)) return session;
  const auto& sessions = store_.sessions();
  if (std::ranges::find(sessions, session, &StoredSession::session) != sessions.end()) {
    throw std::runtime_error("part " + std::to_string(part) + " needs session " +
                             std::to_string(session) + ", which is another run of the log");
  }
  store_.begin_part(session, part, config_.options);
  return session;
}

bool Resumption::has_all_slices(const StoredSession& part) const {
  return part.slice_chunks_end > 0 &&
         store_.stream(channels::kCloudSlice, part.session).next_sequence() >=
             part.slice_chunks_end;
}

bool Resumption::had_ended() const {
  return continued_.back().final_slice_begun && !continued_.back().part_follows;
}

const StoredSession* Resumption::ended_session() const {
  if (continued_.empty() || !had_ended()) return nullptr;
  const auto is_whole = [this](const StoredSession& part) { return has_all_slices(part); };
  return std::ranges::all_of(continued_, is_whole) ? &continued_.back() : nullptr;
}

std::unique_ptr<FrameSource> Resumption::attach(std::unique_ptr<FrameSource> source) {
  if (continued_.empty()) return source;
  if (source->status().frames_total >= 0) {
    return std::make_unique<ResumedSource>(std::move(source), mapped_utimes(), had_ended());
  }
  if (has_all_frames()) return stored_frames_before(std::move(source));
  spdlog::warn(
      "session {} cannot be continued: a camera cannot repeat the frames that were mapped. Its "
      "slices "
      "are still sent to those who ask; a new session begins",
      session_);
  begin_run(new_session());
  return source;
}

/// A frame that ended a part is the first one of the next, too.
std::vector<std::int64_t> Resumption::mapped_utimes() const {
  std::vector<std::int64_t> utimes;
  for (const StoredSession& part : continued_) {
    for (const std::int64_t utime : part.mapped_utimes) {
      if (utimes.empty() || utime > utimes.back()) utimes.push_back(utime);
    }
  }
  return utimes;
}

bool Resumption::has_pose(int part, std::int64_t utime) const {
  if (part >= std::ssize(continued_)) return false;
  const auto& utimes = continued_[static_cast<std::size_t>(part)].mapped_utimes;
  return !utimes.empty() && utime <= utimes.back();
}

bool Resumption::has_all_frames() const {
  const StoredSession& first = continued_.front();
  const std::int64_t stored = store_.stream(channels::kRgbdFrame, session_).next_sequence();
  return stored > 0 && stored == first.frame_chunks_end &&
         first.last_frame_utime >= last_mapped_utime_;
}

std::unique_ptr<FrameSource> Resumption::stored_frames_before(
    std::unique_ptr<FrameSource> camera) const {
  constexpr std::int64_t kShortestPause_us = 33'000;  // if the wall clock was set back
  const std::int64_t pause_us = wall_clock_us() - continued_.back().last_event_utime;
  return std::make_unique<StoredThenLiveSource>(
      store_.stream(channels::kRgbdFrame, session_), continued_.front().frame_chunks_end,
      config_.max_range_m, std::move(camera), std::max(pause_us, kShortestPause_us), had_ended());
}

bool Resumption::has_caught_up(std::int64_t last_utime) const {
  return last_utime >= last_mapped_utime_;
}

}  // namespace kintsugi::mapper
