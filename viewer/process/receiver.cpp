#include "viewer/process/receiver.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi::viewer {

Receiver::Receiver(const OnMessage& on_message, OnBad on_bad)
    : on_message_(on_message),
      on_bad_(std::move(on_bad)),
      slices_(
          channels::kCloudSlice, [this](CloudSlice slice) { on_message_(std::move(slice)); },
          [this](const DecodeError& reason) { bad(reason); }),
      updates_(
          channels::kSegmentUpdate,
          [this](SegmentUpdate update) { on_message_(std::move(update)); },
          [this](const DecodeError& reason) { bad(reason); }) {}

void Receiver::subscribe(Bus& bus) {
  slices_.subscribe(bus);
  updates_.subscribe(bus);
  bus.subscribe(channels::kCameraPose, [this](ByteView data) { handle_small<CameraPose>(data); });
  bus.subscribe(channels::kSegmenterStatus,
                [this](ByteView data) { handle_small<SegmenterStatus>(data); });
}

void Receiver::handle(const std::string& channel, ByteView data) {
  slices_.handle(channel, data);
  updates_.handle(channel, data);
  if (channel == channels::kCameraPose) handle_small<CameraPose>(data);
  if (channel == channels::kSegmenterStatus) handle_small<SegmenterStatus>(data);
}

template <SmallMessage Small>
void Receiver::handle_small(ByteView data) {
  Small message;
  try {
    message = decode<Small>(data);
  } catch (const DecodeError& reason) {
    bad(reason);
    return;
  }
  on_message_(std::move(message));
}

void Receiver::bad(const DecodeError& reason) { on_bad_(++bad_, reason.what()); }

std::int64_t Receiver::chunks_missing() const {
  return slices_.counts().chunks_missing + updates_.counts().chunks_missing;
}

std::int64_t Receiver::messages_bad() const { return bad_; }

}  // namespace kintsugi::viewer
