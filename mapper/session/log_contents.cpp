#include "mapper/session/log_contents.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/session/stored_sessions.hpp"

namespace kintsugi::mapper {

bool PlacedSlice::is_whole() const {
  return std::ranges::all_of(chunks, [](const auto& chunk) { return chunk.has_value(); });
}

void LogContents::read(const LogEvent& event, const LogPlace& place) {
  const PlacedEvent placed{place, event.utime};
  if (event.channel == kOptionsChannel) {
    const StoredSession begun = decode_options(event.data);
    const auto name = begun.options.find(kMapNameOption);
    SessionContents& of = sessions_.emplace_back();
    of.session = begun.session;
    of.map_name = name == begun.options.end() ? "" : name->second;
    of.options = placed;
  } else if (event.channel == channels::kCloudSlice) {
    read_slice_chunk(event, placed);
  } else if (event.channel == channels::kKeyframe) {
    read_other_chunk<KeyframeMessage>(event, placed);
  } else if (event.channel == channels::kRgbdFrame) {
    read_other_chunk<RgbdFrameMessage>(event, placed);
  } else if (event.channel == channels::kCameraPose) {
    const auto pose = decode<CameraPose>(event.data);
    session(pose.session).frames.add(pose.utime);
  } else if (has_mapped_frames(event.channel)) {
    const MappedFrames frames = decode_mapped_frames(event.data);
    session(frames.session).frames.add(event.channel, frames);
  } else if (event.channel == channels::kMapperStatus) {
    const auto status = decode<MapperStatus>(event.data);
    session(status.session).last_messages[event.channel] = placed;
  } else if (event.channel == channels::kHeartbeat) {
    const auto heartbeat = decode<Heartbeat>(event.data);
    session(heartbeat.session).last_messages[event.channel + heartbeat.channel] = placed;
  } else if (const auto stream = decode_fates(event)) {
    session(stream->session).fates[stream->channel].add(stream->fates);
  } else {
    throw std::runtime_error("a message on channel '" + event.channel +
                             "', on which a mapper stores none");
  }
}

SessionContents& LogContents::session(std::int64_t number) {
  const auto found = std::ranges::find(sessions_, number, &SessionContents::session);
  if (found == sessions_.end()) {
    throw std::runtime_error("a message of session " + std::to_string(number) +
                             ", which did not begin in this log");
  }
  return *found;
}

void LogContents::read_slice_chunk(const LogEvent& event, const PlacedEvent& placed) {
  const auto chunk = decode_chunk<CloudSlice>(event.data);
  const std::int64_t first = chunk.sequence - chunk.index;
  PlacedSlice& slice = session(chunk.header.session).slices[first];
  if (slice.chunks.size() != static_cast<std::size_t>(chunk.count)) {
    slice = {.sequence = first,
             .id = chunk.header.id,
             .revision = chunk.header.revision,
             .kind = chunk.header.kind,
             .superseded = chunk.header.superseded,
             .chunks = {}};
    slice.chunks.resize(static_cast<std::size_t>(chunk.count));
  }
  slice.chunks.at(static_cast<std::size_t>(chunk.index)) = placed;
}

template <BulkMessage Message>
void LogContents::read_other_chunk(const LogEvent& event, const PlacedEvent& placed) {
  const auto chunk = decode_chunk<Message>(event.data);
  session(chunk.header.session).other_chunks[event.channel][chunk.sequence] = placed;
}

}  // namespace kintsugi::mapper
