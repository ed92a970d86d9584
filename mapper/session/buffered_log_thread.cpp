// The thread of a durable log.

#include <algorithm>
#include <exception>
#include <utility>

#include "mapper/session/buffered_log.hpp"

namespace kintsugi::mapper {

void BufferedLog::write_batches() {
  std::unique_lock lock(mutex_);
  for (bool is_last = false; !is_last;) {
    wake_.wait_for(lock, problem_.empty() ? config_.sync_period : config_.retry_period,
                   [this] { return stopping_; });
    is_last = stopping_;
    // What comes meanwhile waits for the next time.
    std::size_t left = waiting_.size();
    while (left > 0 && !waiting_.empty()) {
      const std::size_t written = write_batch(lock);
      if (written == 0) break;
      left -= std::min(left, written);
    }
  }
}

/// The lock is not held meanwhile: nobody waits for the disk. Returns the number of events that are
/// on it now; 0: there is a problem, which is noted.
std::size_t BufferedLog::write_batch(std::unique_lock<std::mutex>& lock) {
  try {
    continue_in_next_file(lock);
  } catch (const std::exception& error) {
    if (!lock.owns_lock()) lock.lock();
    note_failure(error.what());
    return 0;
  }
  if (waiting_.empty()) return 0;
  batch_ = LogBatch::take_from(waiting_, files_);
  lock.unlock();
  batch_->write(files_);
  lock.lock();
  size_bytes_ = files_.size_bytes();
  LogBatch batch = *std::exchange(batch_, std::nullopt);
  note_written(batch);
  return batch.problem.empty() ? batch.places.size() : 0;
}

/// Where the last file has no room for the next event.
void BufferedLog::continue_in_next_file(std::unique_lock<std::mutex>& lock) {
  const Event& event = waiting_.front();
  if (files_.takes(LogFiles::event_bytes(event.channel, event.data))) return;
  lock.unlock();
  LogWriter next = files_.create_next();
  lock.lock();
  files_.continue_in(std::move(next));
}

void BufferedLog::note_written(LogBatch& batch) {
  for (const LogPlace& place : batch.places) {
    const Event& event = batch.events.front();
    if (event.index != nullptr) event.index->set_written(event.sequence, place);
    waiting_bytes_ -= event.data.size();
    batch.events.pop_front();
  }
  waiting_.splice(waiting_.begin(), batch.events);
  if (batch.problem.empty()) {
    note_success();
  } else {
    note_failure(batch.problem);
  }
}

/// The age of the oldest event that a power cut would take.
BufferedLog::Clock::duration BufferedLog::behind() const {
  const std::list<Event>& oldest = batch_ ? batch_->events : waiting_;
  return oldest.empty() ? Clock::duration::zero() : Clock::now() - oldest.front().since;
}

std::string BufferedLog::behind_text() const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(behind());
  return "log '" + config_.path.string() + "' is " + std::to_string(seconds.count()) +
         " s behind, which a power cut would take: the disk is slow";
}

}  // namespace kintsugi::mapper
