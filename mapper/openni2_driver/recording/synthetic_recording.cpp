#include "mapper/openni2_driver/recording/synthetic_recording.hpp"

namespace kintsugi::mapper {

std::string SyntheticRecording::name() const { return "synthetic://" + sequence_.config().scene; }

cv::Mat_<std::uint16_t> SyntheticRecording::depth(int index, DepthUnit unit) {
  cv::Mat_<std::uint16_t> depth = sequence_.depth_mm(index);
  if (unit == DepthUnit::k100um) depth *= 10;  // the sensor's 5 m fit, see max_depth_value()
  return depth;
}

cv::Mat_<cv::Vec3b> SyntheticRecording::color(int index) {
  return sequence_.truth(index).color_rgb.clone();
}

}  // namespace kintsugi::mapper
