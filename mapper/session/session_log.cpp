#include "mapper/session/session_log.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "mapper/session/stored_stream.hpp"

namespace kintsugi::mapper {
namespace {

/// More chunks in a row than could not be written for want of space: 60 GB.
constexpr std::int64_t kMaxGap = 1'000'000;

}  // namespace

void SessionLog::Config::validate() const {
  check_range<std::int64_t>("max_file_bytes", max_file_bytes, 1'000'000, INT64_MAX);
  check_range<std::size_t>("max_waiting_bytes", max_waiting_bytes, 1, SIZE_MAX);
  check_range<std::int64_t>("retry_period", retry_period.count(), 1, INT64_MAX);
}

SessionLog::SessionLog(const Config& config) : config_(config), files_(open(config)) {}

SessionLog::~SessionLog() = default;

LogFiles SessionLog::open(const Config& config) {
  config.validate();
  if (!config.resume) return {config.path, config.max_file_bytes};
  StoredSessionReader reader;
  LogFiles files(config.path, config.max_file_bytes,
                 [&](const LogEvent& event, const LogPlace& place) {
                   if (const auto chunk = reader.read(event)) {
                     index_stored(*chunk, place);
                   }
                 });
  sessions_ = std::move(reader).sessions();
  if (!files.cut_off().empty()) spdlog::warn("{}", files.cut_off());
  return files;
}

void SessionLog::index_stored(const StoredChunk& chunk, const LogPlace& place) {
  StoredStream& of = stream(chunk.channel, chunk.session);
  const std::int64_t expected = of.next_sequence();
  if (chunk.sequence > expected + kMaxGap) {
    throw std::runtime_error("chunk " + std::to_string(chunk.sequence) + " of " + chunk.channel +
                             ", expected " + std::to_string(expected));
  }
  of.set_place(chunk.sequence, place);
}

void SessionLog::begin_session(std::int64_t session, const MappingOptions& options) {
  const std::scoped_lock lock(mutex_);
  const Bytes data = encode_options(session, options);
  if (config_.resume) {
    append(kOptionsChannel, data, nullptr, 0);
    return;
  }
  try {
    files_.append(wall_clock_us(), kOptionsChannel, data);
  } catch (...) {
    std::error_code ignored;
    if (!config_.path.empty()) std::filesystem::remove(config_.path, ignored);
    throw;
  }
}

void SessionLog::add(const std::string& channel, ByteView message) {
  const std::scoped_lock lock(mutex_);
  append(channel, message, nullptr, 0);
}

StoredStream& SessionLog::stream(const std::string& channel, std::int64_t session) {
  const std::scoped_lock lock(mutex_);
  auto& stream = streams_[{channel, session}];
  if (!stream) stream = std::make_unique<StoredStream>(*this, channel);
  return *stream;
}

void SessionLog::retry() {
  const std::scoped_lock lock(mutex_);
  write_waiting();
}

SessionLog::Report SessionLog::report() const {
  const std::scoped_lock lock(mutex_);
  return {.size_bytes = files_.size_bytes(),
          .waiting_bytes = static_cast<std::int64_t>(waiting_bytes_),
          .lost_chunks = lost_chunks_,
          .problem = problem_};
}

void SessionLog::append(const std::string& channel, ByteView data, StoredStream* stream,
                        std::int64_t sequence) {
  const std::int64_t utime = wall_clock_us();
  write_waiting();
  if (waiting_.empty()) {
    try {
      write(utime, channel, data, stream, sequence);
      return;
    } catch (const std::exception& error) {
      note_failure(error.what());
    }
  }
  keep_waiting({utime, channel, Bytes(data.begin(), data.end()), stream, sequence});
}

void SessionLog::write(std::int64_t utime, const std::string& channel, ByteView data,
                       StoredStream* stream, std::int64_t sequence) {
  const LogPlace place = files_.append(utime, channel, data);
  if (stream != nullptr) stream->set_place(sequence, place);
}

void SessionLog::write_waiting() {
  if (waiting_.empty() || Clock::now() < next_try_) return;
  try {
    while (!waiting_.empty()) {
      const Waiting& event = waiting_.front();
      write(event.utime, event.channel, event.data, event.stream, event.sequence);
      waiting_bytes_ -= event.data.size();
      waiting_.pop_front();
    }
    problem_.clear();
    spdlog::info("the log is written again and has what waited; {} chunks were too many",
                 lost_chunks_);
  } catch (const std::exception& error) {
    note_failure(error.what());
  }
}

void SessionLog::keep_waiting(Waiting event) {
  if (event.stream != nullptr) event.stream->set_waiting(event.sequence);
  waiting_bytes_ += event.data.size();
  waiting_.push_back(std::move(event));
  while (waiting_bytes_ > config_.max_waiting_bytes) {
    const std::size_t before = waiting_bytes_;
    drop_oldest_chunk();
    if (waiting_bytes_ == before) return;  // only poses and statuses: small
  }
}

void SessionLog::drop_oldest_chunk() {
  const auto oldest =
      std::ranges::find_if(waiting_, [](const Waiting& event) { return event.stream != nullptr; });
  if (oldest == waiting_.end()) return;
  oldest->stream->set_lost(oldest->sequence);
  waiting_bytes_ -= oldest->data.size();
  waiting_.erase(oldest);
  if (lost_chunks_++ == 0) {
    spdlog::error("more than {} MB wait for the log: the oldest chunks cannot be sent again",
                  config_.max_waiting_bytes / 1'000'000);
  }
}

void SessionLog::note_failure(const std::string& problem) {
  next_try_ = Clock::now() + config_.retry_period;
  if (problem_.empty()) {
    spdlog::error("{}: mapping goes on, the log waits in memory and is tried again", problem);
  }
  problem_ = problem;
}

}  // namespace kintsugi::mapper
