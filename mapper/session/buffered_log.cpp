#include "mapper/session/buffered_log.hpp"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/bus/bus.hpp"

namespace kintsugi::mapper {

namespace {

/// A durable log promises to lose no more than this, and chunks do not wait longer for the disk.
constexpr std::chrono::seconds kMaxBehind{1};

}  // namespace

void BufferedLog::Config::validate() const {
  check_range<std::int64_t>("max_file_bytes", max_file_bytes, kMinFileBytes, INT64_MAX);
  check_range<std::int64_t>("max_total_bytes", max_total_bytes, 0, INT64_MAX);
  check_range<std::size_t>("max_waiting_bytes", max_waiting_bytes, 1, SIZE_MAX);
  check_range<std::int64_t>("retry_period", retry_period.count(), 1, INT64_MAX);
  check_range<std::int64_t>("sync_period", sync_period.count(), 1, INT64_MAX);
  require(!durable || !path.empty(), "durable", durable, "false for a log without a name");
}

BufferedLog::BufferedLog(const Config& config, const LogFiles::OnEvent& on_event)
    : config_(config), files_(open(config, on_event)), size_bytes_(files_.size_bytes()) {
  if (config_.durable) thread_ = std::thread([this] { write_batches(); });
}

BufferedLog::~BufferedLog() { finish(); }

LogFiles BufferedLog::open(const Config& config, const LogFiles::OnEvent& on_event) {
  config.validate();
  const LogFiles::Config files_config{
      .path = config.path, .max_file_bytes = config.max_file_bytes, .durable = config.durable};
  if (!config.resume) return LogFiles(files_config);
  LogFiles files(files_config, on_event);
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
    begin_new(channel, data);
  } catch (...) {
    files_.remove();
    throw;
  }
}

void BufferedLog::begin_new(const std::string& channel, ByteView data) {
  const std::int64_t utime = wall_clock_us();
  files_.append(utime, channel, data);
  if (config_.durable) {
    files_.begin_batch(utime);  // by it a durable log is known, also when it ends here
    files_.sync();
  }
  size_bytes_ = files_.size_bytes();
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
  if (state == ChunkIndex::State::kMissing || state == ChunkIndex::State::kReplaced) return {};
  if (state == ChunkIndex::State::kWaiting) {
    const auto is_wanted = [&](const Event& event) {
      return event.index == &index && event.sequence == sequence;
    };
    for (const std::list<Event>* events : {&waiting_, batch_ ? &batch_->events : nullptr}) {
      if (events == nullptr) continue;
      const auto waiting = std::ranges::find_if(*events, is_wanted);
      if (waiting != events->end()) return waiting->data;
    }
    return {};
  }
  const LogPlace place = index.place(sequence);
  const std::shared_ptr<const LogWriter> file = files_.file_of(place);
  lock.unlock();  // written data does not change
  try {
    return file->read(place.offset, static_cast<std::size_t>(place.size));
  } catch (const std::exception&) {
    return {};
  }
}

bool BufferedLog::is_safe(const ChunkIndex& index, std::int64_t sequence) const {
  if (!config_.durable || index.state(sequence) != ChunkIndex::State::kWaiting) return true;
  const std::scoped_lock lock(mutex_);
  return behind() > kMaxBehind;
}

void BufferedLog::retry() {
  const std::scoped_lock lock(mutex_);
  if (!config_.durable) return write_waiting();
  if (!problem_.empty() || (behind() > kMaxBehind) == is_behind_) return;
  is_behind_ = !is_behind_;
  if (is_behind_) {
    spdlog::warn("{}: mapping continues; the log waits in memory", behind_text());
  } else {
    spdlog::info("the disk keeps up with the log again");
  }
}

std::vector<LogPart> BufferedLog::closed() const {
  const std::scoped_lock lock(mutex_);
  return files_.closed();
}

std::shared_ptr<LogWriter> BufferedLog::create_base() const {
  return std::make_shared<LogWriter>(files_.create_base());
}

void BufferedLog::replace_first(std::shared_ptr<LogWriter> base, std::size_t count,
                                const std::function<void()>& move) {
  files_.install(*base);
  std::vector<LogPart> replaced;
  {
    const std::scoped_lock lock(mutex_);
    replaced = files_.closed();
    replaced.resize(count);
    // The last file, which the log's thread may be writing now, stays as it is.
    size_bytes_ += base->size_bytes();
    for (const LogPart& part : replaced) size_bytes_ -= part.file->size_bytes();
    files_.use(std::move(base), count);
    move();
  }
  files_.remove(replaced);
}

void BufferedLog::finish() {
  if (!config_.durable) return retry();
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

BufferedLog::Report BufferedLog::report() const {
  const std::scoped_lock lock(mutex_);
  const bool is_behind = config_.durable && problem_.empty() && behind() > kMaxBehind;
  return {.size_bytes = size_bytes_,
          .waiting_bytes = static_cast<std::int64_t>(waiting_bytes_),
          .lost_chunks = lost_chunks_,
          .problem = is_behind ? behind_text() : problem_};
}

void BufferedLog::append(const std::string& channel, ByteView data, ChunkIndex* index,
                         std::int64_t sequence) {
  const std::int64_t utime = wall_clock_us();
  if (!config_.durable) write_waiting();
  if (!config_.durable && waiting_.empty()) {
    try {
      write(utime, channel, data, index, sequence);
      return;
    } catch (const std::exception& error) {
      note_failure(error.what());
    }
  }
  keep_waiting({utime, channel, Bytes(data.begin(), data.end()), index, sequence, Clock::now()});
}

void BufferedLog::write(std::int64_t utime, const std::string& channel, ByteView data,
                        ChunkIndex* index, std::int64_t sequence) {
  const LogPlace place = files_.append(utime, channel, data);
  if (index != nullptr) index->set_written(sequence, place);
  size_bytes_ = files_.size_bytes();
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
    note_success();
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

void BufferedLog::note_success() {
  if (problem_.empty()) return;
  problem_.clear();
  spdlog::info(
      "the log can be written again and contains the events that waited; {} chunks were "
      "dropped",
      lost_chunks_);
}

}  // namespace kintsugi::mapper
