#include "mapper/core/relocalization/keyframe_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kThumbnailCols = 20;
constexpr int kThumbnailRows = 15;
constexpr double kMinValidShare = 0.25;  ///< of a cell's pixels
constexpr double kMinCommonShare = 0.4;  ///< of a thumbnail's cells

float mean_of_valid(const cv::Mat_<float>& depth_m) {
  double sum = 0.0;
  int count = 0;
  for (const float z : depth_m) {
    if (std::isnan(z)) continue;
    sum += z;
    ++count;
  }
  const bool enough = count >= kMinValidShare * static_cast<double>(depth_m.total()) && count > 0;
  return enough ? static_cast<float>(sum / count) : kNaN;
}

ImageFeatures features_of(const cv::Mat& gray, const SurfaceMap& surface_C, int max_features) {
  ImageFeatures features;
  std::vector<cv::KeyPoint> corners;
  cv::Mat descriptors;
  cv::ORB::create(max_features)->detectAndCompute(gray, cv::noArray(), corners, descriptors);
  features.descriptors = descriptors;
  const Intrinsics& camera = surface_C.intrinsics;
  const float scale = static_cast<float>(camera.width) / static_cast<float>(gray.cols);
  for (const cv::KeyPoint& corner : corners) {
    // Pixel centres are at integer coordinates in both images.
    const float u = (corner.pt.x + 0.5F) * scale - 0.5F;
    const float v = (corner.pt.y + 0.5F) * scale - 0.5F;
    features.rays_C.emplace_back((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy);
    const int col = std::clamp(static_cast<int>(std::lround(u)), 0, camera.width - 1);
    const int row = std::clamp(static_cast<int>(std::lround(v)), 0, camera.height - 1);
    features.depths_m.push_back(surface_C.depth_m(row, col));
  }
  return features;
}

}  // namespace

cv::Mat_<float> thumbnail_of(const cv::Mat_<float>& depth_m) {
  cv::Mat_<float> thumbnail(kThumbnailRows, kThumbnailCols, kNaN);
  for (int v = 0; v < kThumbnailRows; ++v) {
    const cv::Range rows(v * depth_m.rows / kThumbnailRows,
                         (v + 1) * depth_m.rows / kThumbnailRows);
    for (int u = 0; u < kThumbnailCols; ++u) {
      const cv::Range cols(u * depth_m.cols / kThumbnailCols,
                           (u + 1) * depth_m.cols / kThumbnailCols);
      thumbnail(v, u) = mean_of_valid(depth_m(rows, cols));
    }
  }
  return thumbnail;
}

KeyframeAppearance appearance_of(const TrackingInput& frame, int max_features) {
  const SurfaceMap& finest = frame.surface_C.front();
  const SurfaceMap& coarse = frame.surface_C[std::min<std::size_t>(1, frame.surface_C.size() - 1)];
  KeyframeAppearance appearance;
  appearance.thumbnail_m = thumbnail_of(coarse.depth_m);
  if (frame.color_rgb.empty()) return appearance;
  cv::Mat gray;
  cv::cvtColor(frame.color_rgb, gray, cv::COLOR_RGB2GRAY);
  cv::Mat small;
  cv::resize(gray, small, coarse.depth_m.size(), 0, 0, cv::INTER_AREA);
  appearance.intensity = small;
  appearance.features = features_of(gray, finest, max_features);
  return appearance;
}

double thumbnail_difference(const cv::Mat_<float>& a_m, const cv::Mat_<float>& b_m) {
  double sum = 0.0;
  int common = 0;
  for (int v = 0; v < a_m.rows; ++v) {
    for (int u = 0; u < a_m.cols; ++u) {
      const double a = a_m(v, u);
      const double b = b_m(v, u);
      if (std::isnan(a) || std::isnan(b)) continue;
      sum += std::abs(a - b) / (0.5 * (a + b));
      ++common;
    }
  }
  return common >= kMinCommonShare * static_cast<double>(a_m.total())
             ? sum / common
             : std::numeric_limits<double>::infinity();
}

}  // namespace kintsugi::mapper
