#include "mapper/session/chunk_fates.hpp"

#include <algorithm>
#include <array>

#include "lcmtypes/channels.hpp"

namespace kintsugi::mapper {
namespace {

struct Kind {
  const char* channel;
  SequenceSet ChunkFates::*set;
};
constexpr std::array<Kind, 3> kKinds = {{{channels::kChunksReplaced, &ChunkFates::replaced},
                                         {"MAPPER_CHUNKS_SUPERSEDED", &ChunkFates::superseded},
                                         {"MAPPER_CHUNKS_CHANGED", &ChunkFates::changed}}};

}  // namespace

void ChunkFates::add(const ChunkFates& others) {
  for (const Kind& kind : kKinds) {
    for (const SequenceRange& range : (others.*kind.set).ranges()) (this->*kind.set).insert(range);
  }
}

std::vector<std::pair<std::string, Bytes>> encode_fates(const FatesOfStream& stream,
                                                        const std::string& map_name) {
  std::vector<std::pair<std::string, Bytes>> events;
  for (const Kind& kind : kKinds) {
    const std::vector<SequenceRange> ranges = (stream.fates.*kind.set).ranges();
    for (std::size_t from = 0; from < ranges.size(); from += kMaxResendRanges) {
      const std::size_t to = std::min<std::size_t>(from + kMaxResendRanges, ranges.size());
      ChunksReplaced message{
          .session = stream.session, .channel = stream.channel, .map_name = map_name, .ranges = {}};
      message.ranges.assign(ranges.data() + from, ranges.data() + to);
      events.emplace_back(kind.channel, encode(message));
    }
  }
  return events;
}

std::optional<FatesOfStream> decode_fates(const LogEvent& event) {
  const auto kind = std::ranges::find_if(
      kKinds, [&](const Kind& candidate) { return event.channel == candidate.channel; });
  if (kind == kKinds.end()) return {};
  const auto message = decode<ChunksReplaced>(event.data);
  FatesOfStream stream{.channel = message.channel, .session = message.session, .fates = {}};
  for (const SequenceRange& range : message.ranges) (stream.fates.*kind->set).insert(range);
  return stream;
}

}  // namespace kintsugi::mapper
