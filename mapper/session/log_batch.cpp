#include "mapper/session/log_batch.hpp"

#include <exception>

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kMaxBytes = 16'000'000;

}  // namespace

LogBatch LogBatch::take_from(std::list<WaitingEvent>& waiting, const LogFiles& files) {
  LogBatch batch;
  std::int64_t bytes = 0;
  while (!waiting.empty() && (batch.events.empty() || bytes < kMaxBytes)) {
    const WaitingEvent& next = waiting.front();
    const std::int64_t event_bytes = files.event_bytes(next.channel, next.data);
    if (!batch.events.empty() && !files.has_room(bytes + event_bytes)) break;
    bytes += event_bytes;
    batch.events.splice(batch.events.end(), waiting, waiting.begin());
  }
  return batch;
}

void LogBatch::write(LogFiles& files) {
  const LogWriter::End before = files.end();
  try {
    files.begin_batch(events.front().utime);
    for (const WaitingEvent& event : events) {
      places.push_back(files.append(event.utime, event.channel, event.data));
    }
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (places.empty()) return files.undo(before);
  try {
    files.sync();
  } catch (const std::exception& error) {
    problem = error.what();
    places.clear();
    files.undo(before);
  }
}

}  // namespace kintsugi::mapper
