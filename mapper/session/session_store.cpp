#include "mapper/session/session_store.hpp"

#include <stdexcept>

namespace kintsugi::mapper {
namespace {

/// Limit for consecutive chunks missing in a log because the disk was full: 60 GB.
constexpr std::int64_t kMaxGap = 1'000'000;

}  // namespace

SessionStore::SessionStore(const Config& config)
    : log_(config,
           [this](const LogEvent& event, const LogPlace& place) { read_event(event, place); }) {}

void SessionStore::read_event(const LogEvent& event, const LogPlace& place) {
  const auto chunk = reader_.read(event);
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

StoredStream& SessionStore::stream(const std::string& channel, std::int64_t session) {
  const std::scoped_lock lock(mutex_);
  auto& stream = streams_[{channel, session}];
  if (!stream) stream = std::make_unique<StoredStream>(log_, channel);
  return *stream;
}

}  // namespace kintsugi::mapper
