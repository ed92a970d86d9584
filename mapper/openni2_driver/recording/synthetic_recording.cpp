#include "mapper/openni2_driver/recording/synthetic_recording.hpp"

#include "mapper/synthetic/render/ground_truth.hpp"

namespace kintsugi::mapper {

SyntheticRecording::SyntheticRecording(const synthetic::Sequence::Config& config)
    : sequence_(config) {
  if (!config.ground_truth.empty()) synthetic::write_ground_truth(sequence_, config.ground_truth);
}

std::string SyntheticRecording::name() const { return "synthetic://" + sequence_.config().scene; }

cv::Mat_<std::uint16_t> SyntheticRecording::depth(int index, DepthUnit unit) {
  cv::Mat_<std::uint16_t> depth = sequence_.depth_mm(index);
  if (unit == DepthUnit::k100um) {
    constexpr int kUnitsPerMm = 10;
    const int farthest_mm = max_depth_value(unit) / kUnitsPerMm;
    depth.setTo(0, depth > farthest_mm);
    depth *= kUnitsPerMm;
  }
  return depth;
}

cv::Mat_<cv::Vec3b> SyntheticRecording::color(int index) { return sequence_.color_rgb(index); }

}  // namespace kintsugi::mapper
