#include "mapper/source/bus/rgbd_frame_encoder.hpp"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "mapper/source/frames/depth_values.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kFineUnitsPerM = 10000.0;
constexpr double kCoarseUnitsPerM = 5000.0;

double choose_units_per_m(const cv::Mat_<float>& depth_m) {
  const bool near = std::ranges::all_of(depth_m, [](float z) {
    return !(z > kMaxDepthValue / kFineUnitsPerM);
  });  // NaN is not beyond
  return near ? kFineUnitsPerM : kCoarseUnitsPerM;
}

}  // namespace

RgbdFrameMessage encode_rgbd_frame(const RgbdFrame& frame, std::int64_t session, int jpeg_quality) {
  RgbdFrameMessage message;
  message.utime = frame.utime;
  message.color_utime = frame.utime;
  message.session = session;
  message.frame_index = frame.frame_index;
  message.intrinsics = frame.intrinsics;
  message.depth_units_per_m = choose_units_per_m(frame.depth_m);
  constexpr int kFastest = 1;
  cv::imencode(".png", depth_values(frame.depth_m, message.depth_units_per_m), message.depth_png,
               {cv::IMWRITE_PNG_COMPRESSION, kFastest});
  if (frame.color_rgb.empty()) return message;
  cv::Mat bgr;
  cv::cvtColor(frame.color_rgb, bgr, cv::COLOR_RGB2BGR);
  if (jpeg_quality > 0) {
    cv::imencode(".jpg", bgr, message.color_jpeg, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality});
  } else {
    cv::imencode(".png", bgr, message.color_jpeg, {cv::IMWRITE_PNG_COMPRESSION, kFastest});
  }
  return message;
}

}  // namespace kintsugi::mapper
