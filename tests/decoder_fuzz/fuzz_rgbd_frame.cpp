// RGBD_FRAME messages, from chunks to depth in metres.

#include <stdexcept>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "mapper/openni2_driver/formats/image_decoder.hpp"
#include "mapper/source/frames/frame_converter.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace {

using namespace kintsugi::mapper;  // NOLINT(google-build-using-namespace)

/// As the mapper's source on the bus does.
void convert(const kintsugi::RgbdFrameMessage& message) {
  const cv::Size size(message.intrinsics.width, message.intrinsics.height);
  try {
    RawFrame raw{.utime = message.utime,
                 .frame_index = message.frame_index,
                 .depth_raw = decode_depth(message.depth_png, size, "depth"),
                 .color_rgb = {}};
    if (!message.color_jpeg.empty())
      raw.color_rgb = decode_color(message.color_jpeg, size, "color");
    const FrameConverter converter(message.intrinsics, message.depth_units_per_m, 5.0);
    const RgbdFrame frame = converter.convert(raw);
    kintsugi::fuzzing::require(frame.depth_m.size() == size, "a frame has the size it says");
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kintsugi::StreamSubscriber<kintsugi::RgbdFrameMessage> subscriber(kintsugi::channels::kRgbdFrame,
                                                                    convert);
  for (const auto& event : kintsugi::fuzzing::read_events({data, size})) {
    (void)subscriber.handle(event.channel, event.data);
  }
  return 0;
}
