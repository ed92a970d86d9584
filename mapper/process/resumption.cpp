#include "mapper/process/resumption.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "mapper/process/mapping_options.hpp"
#include "mapper/process/resumed_source.hpp"
#include "mapper/process/stored_stream.hpp"

namespace kintsugi::mapper {

Resumption::Resumption(SessionLog& log, const Options& options)
    : log_(log), options_(mapping_options(options)), wanted_session_(options.session) {
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
  spdlog::warn(
      "session {} cannot go on: its camera does not give the same frames again. What it published "
      "is still served; a new session begins",
      session_);
  wanted_session_ = 0;
  begin_new_session();
  return source;
}

bool Resumption::has_caught_up(std::int64_t last_utime) const {
  return last_utime >= last_mapped_utime_;
}

}  // namespace kintsugi::mapper
