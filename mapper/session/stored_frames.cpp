#include "mapper/session/stored_frames.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "lcmtypes/codec/codec.hpp"
#include "mapper/source/bus/rgbd_frame_encoder.hpp"

namespace kintsugi::mapper {

FrameStore::FrameStore(StoredStream& stream, std::int64_t session, std::int64_t stored_until_utime)
    : stream_(stream), session_(session), stored_until_utime_(stored_until_utime) {}

void FrameStore::add(const RgbdFrame& frame) {
  if (frame.utime <= stored_until_utime_) return;
  constexpr int kWithoutLoss = 0;
  const RgbdFrameMessage message = encode_rgbd_frame(frame, session_, kWithoutLoss);
  const std::int32_t count = num_chunks(message, kDefaultMaxChunkBytes);
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int64_t sequence = stream_.next_sequence();
    stream_.add(sequence, encode_chunk(message, sequence, i, kDefaultMaxChunkBytes));
  }
}

StoredThenLiveSource::StoredThenLiveSource(const StoredStream& stored, std::int64_t chunks_end,
                                           double max_range_m, std::unique_ptr<FrameSource> camera,
                                           std::int64_t pause_us, bool ends_there)
    : stored_(stored),
      chunks_end_(chunks_end),
      decoder_(max_range_m, std::nullopt),
      camera_(std::move(camera)),
      pause_us_(pause_us),
      ends_there_(ends_there) {}

std::optional<RgbdFrame> StoredThenLiveSource::next() {
  if (next_chunk_ < chunks_end_) return read_stored();
  if (ends_there_) return std::nullopt;
  auto frame = camera_->next();
  if (!frame) return frame;
  if (!utime_shift_) {
    utime_shift_ = last_utime_ + pause_us_ - frame->utime;
    index_shift_ = last_index_ + 1 - frame->frame_index;
  }
  frame->utime += *utime_shift_;
  frame->frame_index += index_shift_;
  return frame;
}

RgbdFrame StoredThenLiveSource::read_stored() {
  std::vector<Chunk<RgbdFrameMessage>> chunks;
  do {
    const auto data = stored_.find(next_chunk_++);
    if (!data) {
      throw std::runtime_error("a frame of the session to resume cannot be read from its log");
    }
    chunks.push_back(decode_chunk<RgbdFrameMessage>(*data));
  } while (chunks.back().index + 1 < chunks.back().count && next_chunk_ < chunks_end_);
  RgbdFrame frame = decoder_.decode(join(chunks));
  ++num_stored_;
  last_utime_ = frame.utime;
  last_index_ = frame.frame_index;
  return frame;
}

SourceStatus StoredThenLiveSource::status() const {
  SourceStatus status = camera_->status();
  status.counts.frames_delivered += num_stored_;
  if (ends_there_) {
    status.end_reason = "the session was ended here";
    status.ended_well = true;
  }
  return status;
}

}  // namespace kintsugi::mapper
