#include "mapper/source/bus/rgbd_frame_decoder.hpp"

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/formats/image_decoder.hpp"
#include "mapper/source/frames/frame_converter.hpp"

namespace kintsugi::mapper {

struct RgbdFrameDecoder::Conversion {
  Intrinsics intrinsics;
  double depth_units_per_m;
  FrameConverter converter;
};

RgbdFrameDecoder::RgbdFrameDecoder(double max_range_m, std::optional<Intrinsics> calibration)
    : max_range_m_(max_range_m), calibration_(calibration) {}

RgbdFrameDecoder::~RgbdFrameDecoder() = default;

RgbdFrame RgbdFrameDecoder::decode(const RgbdFrameMessage& message) {
  const Intrinsics& intrinsics = calibration_ ? *calibration_ : message.intrinsics;
  const cv::Size size(intrinsics.width, intrinsics.height);
  RawFrame raw{.utime = message.utime,
               .frame_index = message.frame_index,
               .depth_raw = decode_depth(message.depth_png, size, "depth of a message"),
               .color_rgb = {}};
  if (!message.color_jpeg.empty()) {
    raw.color_rgb = decode_color(message.color_jpeg, size, "colour of a message");
  }
  const double units_per_m = message.depth_units_per_m;
  if (!conversion_ || conversion_->intrinsics != intrinsics ||
      conversion_->depth_units_per_m != units_per_m) {
    conversion_ = std::make_unique<Conversion>(
        Conversion{intrinsics, units_per_m, FrameConverter(intrinsics, units_per_m, max_range_m_)});
  }
  return conversion_->converter.convert(raw);
}

}  // namespace kintsugi::mapper
