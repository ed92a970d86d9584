#include "mapper/source/openni2/openni2_image.hpp"

#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

#include "mapper/source/frames/device_mode.hpp"

namespace kintsugi::mapper {
namespace {

/// The frame's pixels where OpenNI2 has them.
cv::Mat view(const openni::VideoFrameRef& frame, int type) {
  const auto bytes_per_line = static_cast<std::int64_t>(frame.getWidth()) * CV_ELEM_SIZE(type);
  const std::int64_t stride = frame.getStrideInBytes();
  const bool whole = frame.getWidth() > 0 && frame.getHeight() > 0 && stride >= bytes_per_line &&
                     stride * (frame.getHeight() - 1) + bytes_per_line <= frame.getDataSize();
  if (!whole) {
    throw std::runtime_error("a frame of " + std::to_string(frame.getDataSize()) +
                             " bytes, expected " + std::to_string(frame.getWidth()) + "x" +
                             std::to_string(frame.getHeight()) + " pixels of " +
                             std::to_string(CV_ELEM_SIZE(type)) + " bytes");
  }
  return {frame.getHeight(), frame.getWidth(), type, const_cast<void*>(frame.getData()),
          static_cast<std::size_t>(stride)};
}

/// Where the frame's pixels are in its stream's image.
cv::Rect part_of_image(const openni::VideoFrameRef& frame) {
  const openni::VideoMode& mode = frame.getVideoMode();
  const cv::Rect image(0, 0, mode.getResolutionX(), mode.getResolutionY());
  const bool cropped = frame.getCroppingEnabled();
  const cv::Rect part(cropped ? frame.getCropOriginX() : 0, cropped ? frame.getCropOriginY() : 0,
                      frame.getWidth(), frame.getHeight());
  if (cropped ? (part & image) == part : part == image) return part;
  throw std::runtime_error("a frame of " + std::to_string(part.width) + "x" +
                           std::to_string(part.height) + " pixels" +
                           (cropped ? " cropped beyond its mode of " : ", expected ") +
                           std::to_string(image.width) + "x" + std::to_string(image.height));
}

/// Undoes cropping, then mirroring; always a copy.
cv::Mat whole_image(const openni::VideoFrameRef& frame, const cv::Mat& pixels, bool mirrored) {
  const openni::VideoMode& mode = frame.getVideoMode();
  const cv::Rect part = part_of_image(frame);
  cv::Mat whole(mode.getResolutionY(), mode.getResolutionX(), pixels.type());
  if (part.size() != whole.size()) whole.setTo(cv::Scalar::all(0));
  pixels.copyTo(whole(part));
  if (mirrored) cv::flip(whole, whole, 1);
  return whole;
}

cv::Mat to_rgb(const openni::VideoFrameRef& frame) {
  cv::Mat rgb;
  switch (frame.getVideoMode().getPixelFormat()) {
    case openni::PIXEL_FORMAT_RGB888:
      return view(frame, CV_8UC3);
    case openni::PIXEL_FORMAT_YUV422:
      cv::cvtColor(view(frame, CV_8UC2), rgb, cv::COLOR_YUV2RGB_UYVY);
      return rgb;
    case openni::PIXEL_FORMAT_YUYV:
      cv::cvtColor(view(frame, CV_8UC2), rgb, cv::COLOR_YUV2RGB_YUY2);
      return rgb;
    case openni::PIXEL_FORMAT_GRAY8:
      cv::cvtColor(view(frame, CV_8UC1), rgb, cv::COLOR_GRAY2RGB);
      return rgb;
    default:
      throw std::runtime_error("colour in pixel format " +
                               std::to_string(frame.getVideoMode().getPixelFormat()) +
                               ", expected RGB888, YUV422, YUYV or GRAY8");
  }
}

}  // namespace

cv::Mat_<std::uint16_t> copy_depth(const openni::VideoFrameRef& frame, bool mirrored) {
  const auto format = frame.getVideoMode().getPixelFormat();
  if (format != openni::PIXEL_FORMAT_DEPTH_1_MM && format != openni::PIXEL_FORMAT_DEPTH_100_UM) {
    throw std::runtime_error("depth in pixel format " + std::to_string(format) +
                             ", expected 1 mm or 100 um units");
  }
  return whole_image(frame, view(frame, CV_16UC1), mirrored);
}

cv::Mat_<cv::Vec3b> copy_color(const openni::VideoFrameRef& frame, bool mirrored,
                               cv::Size depth_size) {
  cv::Mat rgb = whole_image(frame, to_rgb(frame), mirrored);
  if (rgb.size() == depth_size) return rgb;
  const auto part = registered_part(rgb.size(), depth_size);
  if (!part) throw std::runtime_error("colour that does not cover the depth image");
  const bool smaller = depth_size.width < rgb.cols;
  cv::Mat scaled;
  cv::resize(rgb(*part), scaled, depth_size, 0.0, 0.0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
  return scaled;
}

}  // namespace kintsugi::mapper
