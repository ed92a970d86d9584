#include "mapper/session/session_store.hpp"

#include <algorithm>
#include <stdexcept>

#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/chunk_fates.hpp"

namespace kintsugi::mapper {
namespace {

/// Limit for consecutive chunks missing in a log because the disk was full: 60 GB.
constexpr std::int64_t kMaxGap = 1'000'000;

BufferedLog::Config log_config(const SessionStore::Config& config) {
  config.validate();
  BufferedLog::Config log = config;
  if (config.max_total_bytes > 0) {
    const auto share = static_cast<std::int64_t>(StoreLimit::kShareOfFile *
                                                 static_cast<double>(config.max_total_bytes));
    log.max_file_bytes = std::min(log.max_file_bytes, std::max(kMinFileBytes, share));
  }
  return log;
}

}  // namespace

SessionStore::SessionStore(const Config& config)
    : log_(log_config(config),
           [this](const LogEvent& event, const LogPlace& place) { read_event(event, place); }),
      limit_(log_, config.max_total_bytes, config.durable,
             [this](std::int32_t last_file, const RewrittenStreams& streams) {
               move_chunks(last_file, streams);
             }) {}

void SessionStore::read_event(const LogEvent& event, const LogPlace& place) {
  const auto chunk = reader_.read(event);
  if (const auto told = decode_fates(event)) {
    stream(told->channel, told->session).index().add_fates(told->fates);
  }
  if (!chunk) return;
  ChunkIndex& index = stream(chunk->channel, chunk->session).index();
  if (chunk->sequence > index.end() + kMaxGap) {
    throw std::runtime_error("chunk " + std::to_string(chunk->sequence) + " of " + chunk->channel +
                             ", expected " + std::to_string(index.end()));
  }
  index.set_written(chunk->sequence, place);
}

void SessionStore::begin_session(std::int64_t session, const MappingOptions& options) {
  log_.begin(kOptionsChannel, encode_options(session, options));
}

void SessionStore::move_chunks(std::int32_t last_file, const RewrittenStreams& streams) {
  for (const auto& [key, rewritten] : streams) {
    stream(key.first, key.second).index().move(last_file, rewritten.kept, rewritten.fates);
  }
}

void SessionStore::retry() {
  log_.retry();
  limit_.poll();
}

void SessionStore::finish() {
  limit_.finish();
  log_.finish();
}

BufferedLog::Report SessionStore::report() const {
  BufferedLog::Report report = log_.report();
  if (report.problem.empty()) report.problem = limit_.problem();
  return report;
}

StoredStream& SessionStore::stream(const std::string& channel, std::int64_t session) {
  const std::scoped_lock lock(mutex_);
  auto& stream = streams_[{channel, session}];
  if (!stream) stream = std::make_unique<StoredStream>(log_, channel);
  return *stream;
}

}  // namespace kintsugi::mapper
