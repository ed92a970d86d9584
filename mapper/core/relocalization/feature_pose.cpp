#include "mapper/core/relocalization/feature_pose.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

namespace kintsugi::mapper {
namespace {

constexpr float kNearestRatio =
    0.8F;  ///< of the distance to the nearest descriptor to that of the second nearest
constexpr float kNearBits = 64.0F;
constexpr int kMinInliers = 12;
constexpr double kMinInlierShare = 0.4;  ///< that is looked for, of many correspondences
constexpr int kSampleSize = 4;           ///< three correspondences, and one to choose by
/// Of the samples that are inliers: others lie too close together, or in a line, to show the rest.
constexpr double kGoodShare = 0.5;
constexpr float kMaxError = 3.0F / 525.0F;  ///< of a projected point, at unit focal length
constexpr double kConfidence = 0.99;

struct Correspondences {
  std::vector<cv::Point3f> points_K;
  std::vector<cv::Point2f> rays_C;
};

Correspondences match(const ImageFeatures& features_K, const ImageFeatures& features_C) {
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_HAMMING)
      .knnMatch(features_C.descriptors, features_K.descriptors, nearest, 2);
  Correspondences found;
  for (const std::vector<cv::DMatch>& two : nearest) {
    if (two.size() < 2 || two[0].distance > kNearBits) continue;
    if (two[0].distance > kNearestRatio * two[1].distance) continue;
    const float z = features_K.depths_m[two[0].trainIdx];
    if (std::isnan(z)) continue;
    const cv::Point2f& ray_K = features_K.rays_C[two[0].trainIdx];
    found.points_K.emplace_back(z * ray_K.x, z * ray_K.y, z);
    found.rays_C.push_back(features_C.rays_C[two[0].queryIdx]);
  }
  return found;
}

Correspondences only(const std::vector<int>& numbers, const Correspondences& of) {
  Correspondences those;
  for (const int i : numbers) {
    those.points_K.push_back(of.points_K[i]);
    those.rays_C.push_back(of.rays_C[i]);
  }
  return those;
}

/// How many samples it takes until one of them is good, with kConfidence. Fewer than kMinInliers
/// are never enough, so that a few correspondences need only a few samples.
int num_trials(std::size_t num_found) {
  const double inlier_share =
      std::max(kMinInlierShare, static_cast<double>(kMinInliers) / static_cast<double>(num_found));
  const double good_share = kGoodShare * std::pow(inlier_share, kSampleSize);
  return static_cast<int>(std::ceil(std::log1p(-kConfidence) / std::log1p(-good_share)));
}

int num_inliers(const Correspondences& found, const cv::Mat& rotation_vector,
                const cv::Mat& translation) {
  std::vector<cv::Point2f> projected;
  cv::projectPoints(found.points_K, rotation_vector, translation, cv::Mat::eye(3, 3, CV_64F),
                    cv::noArray(), projected);
  int number = 0;
  for (std::size_t i = 0; i < projected.size(); ++i) {
    number += cv::norm(projected[i] - found.rays_C[i]) <= kMaxError ? 1 : 0;
  }
  return number;
}

Pose to_pose(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const Eigen::Vector3d r(rotation_vector.at<double>(0), rotation_vector.at<double>(1),
                          rotation_vector.at<double>(2));
  Pose X = Pose::Identity();
  if (r.norm() > 0.0) X.linear() = Eigen::AngleAxisd(r.norm(), r.normalized()).toRotationMatrix();
  X.translation() << translation.at<double>(0), translation.at<double>(1),
      translation.at<double>(2);
  return X;
}

}  // namespace

std::optional<Pose> pose_from_features(const ImageFeatures& features_K,
                                       const ImageFeatures& features_C) {
  if (features_K.size() < 2 || features_C.size() < kMinInliers) return std::nullopt;
  const Correspondences found = match(features_K, features_C);
  if (static_cast<int>(found.points_K.size()) < kMinInliers) return std::nullopt;
  const cv::Mat camera = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat rotation;
  cv::Mat translation;
  std::vector<int> inliers;
  // OpenCV seeds this RANSAC with a constant: the result is reproducible.
  const bool solved = cv::solvePnPRansac(
      found.points_K, found.rays_C, camera, cv::noArray(), rotation, translation, false,
      num_trials(found.points_K.size()), kMaxError, kConfidence, inliers, cv::SOLVEPNP_P3P);
  if (!solved || !cv::checkRange(rotation) || !cv::checkRange(translation)) return std::nullopt;
  // OpenCV ends with EPnP, which is off by decimetres where the points are nearly in a plane.
  const Correspondences agreeing = only(inliers, found);
  cv::solvePnPRefineLM(agreeing.points_K, agreeing.rays_C, camera, cv::noArray(), rotation,
                       translation);
  // Not of the sample's pose: the noise of four points hides inliers.
  if (num_inliers(found, rotation, translation) < kMinInliers) return std::nullopt;
  Pose X_KC = to_pose(rotation, translation).inverse();
  if (!X_KC.matrix().allFinite()) return std::nullopt;
  return X_KC;
}

}  // namespace kintsugi::mapper
