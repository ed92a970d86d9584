#include "mapper/session/stored_sessions.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/chunk_fates.hpp"
#include "mapper/session/mapped_frames.hpp"

namespace kintsugi::mapper {
Bytes encode_options(std::int64_t session, const MappingOptions& options) {
  const std::string text = json_text(nlohmann::json{{"session", session}, {"options", options}});
  return {text.begin(), text.end()};
}

StoredSession decode_options(ByteView data) {
  try {
    const auto json = nlohmann::json::parse(data.begin(), data.end());
    const auto& number = json.at("session");
    if (!number.is_number_integer()) throw std::runtime_error("session is not a whole number");
    StoredSession session;
    session.session = number.get<std::int64_t>();
    if (session.session <= 0) {
      throw std::runtime_error("session is " + std::to_string(session.session) + ", expected > 0");
    }
    session.options = json.at("options").get<MappingOptions>();
    return session;
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("its ") + kOptionsChannel +
                             " cannot be read: " + error.what());
  }
}

std::optional<StoredChunk> StoredSessionReader::read(const LogEvent& event) {
  if (event.channel == kOptionsChannel) {
    begin_session(event);
    return {};
  }
  if (sessions_.empty()) {
    throw std::runtime_error("it begins with channel '" + event.channel +
                             "', so a mapper did not make it with --store");
  }
  sessions_.back().last_event_utime = event.utime;
  if (event.channel == channels::kCloudSlice) return read_slice_chunk(event);
  if (event.channel == channels::kRgbdFrame) return read_frame_chunk(event);
  if (event.channel == channels::kKeyframe) return read_keyframe_chunk(event);
  if (event.channel == channels::kCameraPose) {
    const auto pose = decode<CameraPose>(event.data);
    session(pose.session).frames.add(pose.utime);
  } else if (has_mapped_frames(event.channel)) {
    const MappedFrames frames = decode_mapped_frames(event.data);
    session(frames.session).frames.add(event.channel, frames);
  } else if (event.channel == channels::kMapperStatus) {
    auto status = decode<MapperStatus>(event.data);
    session(status.session).last_status = std::move(status);
  } else if (event.channel == channels::kHeartbeat) {
    (void)decode<Heartbeat>(event.data);
  } else if (const auto stream = decode_fates(event)) {
    (void)session(stream->session);
  } else {
    throw std::runtime_error("a message on channel '" + event.channel +
                             "', on which a mapper stores none");
  }
  return {};
}

void StoredSessionReader::begin_session(const LogEvent& event) {
  StoredSession session = decode_options(event.data);
  session.last_event_utime = event.utime;
  const auto same = [&](const StoredSession& other) { return other.session == session.session; };
  if (std::ranges::any_of(sessions_, same)) {
    throw std::runtime_error("session " + std::to_string(session.session) + " begins again");
  }
  sessions_.push_back(std::move(session));
}

StoredSession& StoredSessionReader::session(std::int64_t number) {
  const auto found = std::ranges::find(sessions_, number, &StoredSession::session);
  if (found == sessions_.end()) {
    throw std::runtime_error("a message of session " + std::to_string(number) +
                             ", which did not begin in this log");
  }
  return *found;
}

StoredChunk StoredSessionReader::read_slice_chunk(const LogEvent& event) {
  const auto chunk = decode_chunk<CloudSlice>(event.data);
  StoredSession& of = session(chunk.header.session);
  if (chunk.header.kind == SliceKind::kFinal) {
    of.final_slice_begun = true;
    of.slice_chunks_end = chunk.sequence - chunk.index + chunk.count;
  }
  return {event.channel, of.session, chunk.sequence};
}

StoredChunk StoredSessionReader::read_keyframe_chunk(const LogEvent& event) {
  const auto chunk = decode_chunk<KeyframeMessage>(event.data);
  return {event.channel, session(chunk.header.session).session, chunk.sequence};
}

StoredChunk StoredSessionReader::read_frame_chunk(const LogEvent& event) {
  const auto chunk = decode_chunk<RgbdFrameMessage>(event.data);
  StoredSession& of = session(chunk.header.session);
  if (chunk.index + 1 == chunk.count) {
    of.frame_chunks_end = chunk.sequence + 1;
    of.last_frame_utime = chunk.header.utime;
  }
  return {event.channel, of.session, chunk.sequence};
}

}  // namespace kintsugi::mapper
