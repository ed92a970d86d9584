#include "mapper/session/log_rewriting.hpp"

#include <algorithm>
#include <stdexcept>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/log_contents.hpp"
#include "mapper/session/log_marks.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/session/slice_needs.hpp"
#include "mapper/session/stored_sessions.hpp"

namespace kintsugi::mapper {
namespace {

/// So that no event is larger than what a mapper writes otherwise.
constexpr std::size_t kMaxFramesOfEvent = 20'000;

class Rewriting {
 public:
  Rewriting(const std::vector<LogPart>& parts, LogWriter& base,
            const std::function<bool()>& is_stopped)
      : parts_(parts), base_(base), is_stopped_(is_stopped) {}

  RewrittenStreams run(bool is_marked) {
    LogContents contents;
    for (const LogPart& part : parts_) read(part, contents);
    const std::int64_t utime =
        contents.sessions().empty() ? 0 : contents.sessions()[0].options.utime;
    base_.append(utime, kBaseChannel, base_before(parts_.back().number + 1));
    for (const SessionContents& session : contents.sessions()) write(session);
    if (is_marked) base_.append(utime, kMarkChannel, mark_at(base_.size_bytes()));
    return std::move(streams_);
  }

 private:
  void go_on_unless_stopped() const {
    if (is_stopped_()) throw std::runtime_error("the log is not rewritten: stopped");
  }

  void read(const LogPart& part, LogContents& contents) const {
    LogReader reader(part.file->open_path(), MessageTrust{});
    while (const auto event = reader.next()) {
      go_on_unless_stopped();
      if (event->channel == kMarkChannel || event->channel == kBaseChannel) continue;
      const auto size = static_cast<std::int32_t>(event->data.size());
      contents.read(*event, {part.number, size, reader.bytes_read() - size});
    }
    if (reader.damage()) throw std::runtime_error(*reader.damage());
  }

  Bytes data_of(const LogPlace& place) const {
    go_on_unless_stopped();
    const auto part = std::ranges::find(parts_, place.file, &LogPart::number);
    return part->file->read(place.offset, static_cast<std::size_t>(place.size));
  }

  void write(const SessionContents& session) {
    const SliceNeeds needs(session, [this](const LogPlace& place) { return data_of(place); });
    copy(kOptionsChannel, session.options);
    write_frames(kMappedFramesChannel, session.frames.mapped_utimes, session);
    write_frames(kTrackedOnlyChannel, session.frames.tracked_only_utimes, session);
    write_fates(session, needs);
    for (const auto& [channel, chunks] : session.other_chunks) {
      for (const auto& [sequence, chunk] : chunks) {
        stream(channel, session).kept.push_back({sequence, copy(channel, chunk)});
      }
    }
    for (const auto& [sequence, slice] : session.slices) write(slice, session, needs);
    for (const auto& [channel, message] : session.last_messages) {
      copy(channel == channels::kMapperStatus ? channel : channels::kHeartbeat, message);
    }
  }

  void write_frames(const std::string& channel, const std::vector<std::int64_t>& utimes,
                    const SessionContents& session) {
    for (std::size_t from = 0; from < utimes.size(); from += kMaxFramesOfEvent) {
      const std::size_t count = std::min(kMaxFramesOfEvent, utimes.size() - from);
      base_.append(session.options.utime, channel,
                   encode_mapped_frames(session.session, {&utimes[from], count}));
    }
  }

  /// Before the chunks, so that who reads the log does not wait for those that are not there.
  void write_fates(const SessionContents& session, const SliceNeeds& needs) {
    for (const auto& [channel, fates] : session.fates) stream(channel, session).fates = fates;
    for (const auto& [sequence, slice] : session.slices) note_fate(slice, session, needs);
    for (const auto& [key, written] : streams_) {
      if (key.second != session.session) continue;
      for (const auto& [channel, data] :
           encode_fates({key.first, key.second, written.fates}, session.map_name)) {
        base_.append(session.options.utime, channel, data);
      }
    }
  }

  void note_fate(const PlacedSlice& slice, const SessionContents& session,
                 const SliceNeeds& needs) {
    const SliceNeeds::Need need = needs.need(slice);
    if (need == SliceNeeds::Need::kWhole) return;
    ChunkFates& fates = stream(channels::kCloudSlice, session).fates;
    const std::int64_t last = slice.sequence + std::ssize(slice.chunks) - 1;
    std::int64_t end = slice.sequence;  // of the chunks that stay
    if (need == SliceNeeds::Need::kShortened) {
      end += num_chunks(needs.shortened(slice), SliceNeeds::max_chunk_bytes(slice));
      fates.changed.insert({slice.sequence, end - 1});
    }
    if (end <= last) fates.replaced.insert({end, last});
    if (slice.superseded) fates.superseded.insert({end, last});
  }

  void write(const PlacedSlice& slice, const SessionContents& session, const SliceNeeds& needs) {
    const SliceNeeds::Need need = needs.need(slice);
    if (need == SliceNeeds::Need::kNone) return;
    std::vector<ChunkIndex::Entry>& kept = stream(channels::kCloudSlice, session).kept;
    if (need == SliceNeeds::Need::kShortened) return write_shortened(slice, needs, kept);
    std::int64_t sequence = slice.sequence;
    for (const auto& chunk : slice.chunks) {
      if (chunk) kept.push_back({sequence, copy(channels::kCloudSlice, *chunk)});
      ++sequence;
    }
  }

  void write_shortened(const PlacedSlice& slice, const SliceNeeds& needs,
                       std::vector<ChunkIndex::Entry>& kept) {
    const CloudSlice shortened = needs.shortened(slice);
    const std::size_t max_bytes = SliceNeeds::max_chunk_bytes(slice);
    for (std::int32_t i = 0; i < num_chunks(shortened, max_bytes); ++i) {
      const Bytes chunk = encode_chunk(shortened, slice.sequence + i, i, max_bytes);
      kept.push_back(
          {slice.sequence + i, append(channels::kCloudSlice, slice.chunks.front()->utime, chunk)});
    }
  }

  RewrittenStream& stream(const std::string& channel, const SessionContents& session) {
    return streams_[{channel, session.session}];
  }

  LogPlace copy(const std::string& channel, const PlacedEvent& event) {
    return append(channel, event.utime, data_of(event.place));
  }

  LogPlace append(const std::string& channel, std::int64_t utime, ByteView data) {
    const std::int64_t offset = base_.append(utime, channel, data);
    return {0, static_cast<std::int32_t>(data.size()), offset};
  }

  const std::vector<LogPart>& parts_;
  LogWriter& base_;
  const std::function<bool()>& is_stopped_;
  RewrittenStreams streams_;
};

}  // namespace

RewrittenStreams rewrite_log(const std::vector<LogPart>& parts, LogWriter& base, bool is_marked,
                             const std::function<bool()>& is_stopped) {
  return Rewriting(parts, base, is_stopped).run(is_marked);
}

}  // namespace kintsugi::mapper
