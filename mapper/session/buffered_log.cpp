#include "mapper/session/buffered_log.hpp"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/bus/bus.hpp"

namespace kintsugi::mapper {

void BufferedLog::Config::validate() const {
  check_range<std::int64_t>("max_file_bytes", max_file_bytes, 1'000'000, INT64_MAX);
  check_range<std::size_t>("max_waiting_bytes", max_waiting_bytes, 1, SIZE_MAX);
  check_range<std::int64_t>("retry_period", retry_period.count(), 1, INT64_MAX);
}

BufferedLog::BufferedLog(const Config& config, const LogFiles::OnEvent& on_event)
    : config_(config), files_(open(config, on_event)) {}

LogFiles BufferedLog::open(const Config& config, const LogFiles::OnEvent& on_event) {
  config.validate();
  if (!config.resume) return {config.path, config.max_file_bytes};
  LogFiles files(config.path, config.max_file_bytes, on_event);
  if (!files.cut_off().empty()) spdlog::warn("{}", files.cut_off());
  return files;
}

void BufferedLog::begin(const std::string& channel, ByteView data) {
  const std::scoped_lock lock(mutex_);
  if (config_.resume) {
    append(channel, data, nullptr, 0);
    return;
  }
  try {
    files_.append(wall_clock_us(), channel, data);
  } catch (...) {
    std::error_code ignored;
    if (!config_.path.empty()) std::filesystem::remove(config_.path, ignored);
    throw;
  }
}

void BufferedLog::append(const std::string& channel, ByteView data) {
  const std::scoped_lock lock(mutex_);
  append(channel, data, nullptr, 0);
}

void BufferedLog::append_chunk(const std::string& channel, ByteView data, ChunkIndex& index,
                               std::int64_t sequence) {
  const std::scoped_lock lock(mutex_);
  append(channel, data, &index, sequence);
}

std::optional<Bytes> BufferedLog::find(const ChunkIndex& index, std::int64_t sequence) const {
  std::unique_lock lock(mutex_);
  const ChunkIndex::State state = index.state(sequence);
  if (state == ChunkIndex::State::kMissing) return {};
  if (state == ChunkIndex::State::kWaiting) {
    const auto waiting = std::ranges::find_if(waiting_, [&](const Event& event) {
      return event.index == &index && event.sequence == sequence;
    });
    if (waiting == waiting_.end()) return {};
    return waiting->data;
  }
  const LogPlace place = index.place(sequence);
  const LogWriter& file = files_.file_of(place);
  lock.unlock();  // written data does not change
  try {
    return file.read(place.offset, static_cast<std::size_t>(place.size));
  } catch (const std::exception&) {
    return {};
  }
}

void BufferedLog::retry() {
  const std::scoped_lock lock(mutex_);
  write_waiting();
}

BufferedLog::Report BufferedLog::report() const {
  const std::scoped_lock lock(mutex_);
  return {.size_bytes = files_.size_bytes(),
          .waiting_bytes = static_cast<std::int64_t>(waiting_bytes_),
          .lost_chunks = lost_chunks_,
          .problem = problem_};
}

void BufferedLog::append(const std::string& channel, ByteView data, ChunkIndex* index,
                         std::int64_t sequence) {
  const std::int64_t utime = wall_clock_us();
  write_waiting();
  if (waiting_.empty()) {
    try {
      write(utime, channel, data, index, sequence);
      return;
    } catch (const std::exception& error) {
      note_failure(error.what());
    }
  }
  keep_waiting({utime, channel, Bytes(data.begin(), data.end()), index, sequence});
}

void BufferedLog::write(std::int64_t utime, const std::string& channel, ByteView data,
                        ChunkIndex* index, std::int64_t sequence) {
  const LogPlace place = files_.append(utime, channel, data);
  if (index != nullptr) index->set_written(sequence, place);
}

void BufferedLog::write_waiting() {
  if (waiting_.empty() || Clock::now() < next_try_) return;
  try {
    while (!waiting_.empty()) {
      const Event& event = waiting_.front();
      write(event.utime, event.channel, event.data, event.index, event.sequence);
      waiting_bytes_ -= event.data.size();
      waiting_.pop_front();
    }
    problem_.clear();
    spdlog::info(
        "the log can be written again and contains the events that waited; {} chunks were "
        "dropped",
        lost_chunks_);
  } catch (const std::exception& error) {
    note_failure(error.what());
  }
}

void BufferedLog::keep_waiting(Event event) {
  if (event.index != nullptr) event.index->set_waiting(event.sequence);
  waiting_bytes_ += event.data.size();
  waiting_.push_back(std::move(event));
  while (waiting_bytes_ > config_.max_waiting_bytes) {
    const std::size_t before = waiting_bytes_;
    drop_oldest_chunk();
    if (waiting_bytes_ == before) return;  // only poses and statuses are left: they are small
  }
}

void BufferedLog::drop_oldest_chunk() {
  const auto oldest =
      std::ranges::find_if(waiting_, [](const Event& event) { return event.index != nullptr; });
  if (oldest == waiting_.end()) return;
  oldest->index->set_missing(oldest->sequence);
  waiting_bytes_ -= oldest->data.size();
  waiting_.erase(oldest);
  if (lost_chunks_++ == 0) {
    spdlog::error(
        "more than {} MB wait for the log: the oldest chunks are dropped and cannot be "
        "sent again",
        config_.max_waiting_bytes / 1'000'000);
  }
}

void BufferedLog::note_failure(const std::string& problem) {
  next_try_ = Clock::now() + config_.retry_period;
  if (problem_.empty()) {
    spdlog::error("{}: mapping continues; the log waits in memory, and writing is tried again",
                  problem);
  }
  problem_ = problem;
}

}  // namespace kintsugi::mapper
