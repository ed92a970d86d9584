#include "mapper/openni2_driver/plugin/imitated_image.hpp"

#include <opencv2/imgproc.hpp>

namespace kintsugi::mapper {

cv::Mat image_in_mode(const cv::Mat& image, cv::Size mode) {
  if (image.size() == mode) return image;
  const bool is_depth = image.type() == CV_16UC1;
  const int rows = is_depth ? mode.height : mode.width * image.rows / image.cols;
  const int method = is_depth ? cv::INTER_NEAREST : cv::INTER_AREA;
  cv::Mat scaled;
  cv::resize(image, scaled, {mode.width, rows}, 0.0, 0.0, method);
  if (rows >= mode.height) return scaled.rowRange(0, mode.height);
  cv::copyMakeBorder(scaled, scaled, 0, mode.height - rows, 0, 0, cv::BORDER_CONSTANT,
                     cv::Scalar(255, 0, 255));
  return scaled;
}

cv::Mat unregistered(const cv::Mat& depth) {
  const int shift = depth.cols / 20;
  cv::Mat shifted = cv::Mat::zeros(depth.size(), depth.type());
  depth.colRange(0, depth.cols - shift).copyTo(shifted.colRange(shift, depth.cols));
  return shifted;
}

void spoil(OniFrame& frame, int number, const CameraImitation& imitation) {
  const auto is_turn = [&](int every) { return every > 0 && number % every == 0; };
  if (is_turn(imitation.misfit_every)) frame.height /= 2;
  if (is_turn(imitation.empty_every)) frame.width = frame.height = frame.dataSize = 0;
}

}  // namespace kintsugi::mapper
