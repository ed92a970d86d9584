#include "mapper/core/relocalization/feature_pose.hpp"

#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

namespace kintsugi::mapper {
namespace {

constexpr float kNearestRatio =
    0.8F;  ///< of the distance to the nearest descriptor to that of the second nearest
constexpr float kNearBits = 64.0F;
constexpr int kMinInliers = 12;
constexpr int kTrials = 200;
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
  cv::Mat rotation;
  cv::Mat translation;
  std::vector<int> inliers;
  // OpenCV seeds this RANSAC with a constant: the result is reproducible.
  const bool solved = cv::solvePnPRansac(found.points_K, found.rays_C, cv::Mat::eye(3, 3, CV_64F),
                                         cv::noArray(), rotation, translation, false, kTrials,
                                         kMaxError, kConfidence, inliers, cv::SOLVEPNP_EPNP);
  if (!solved || static_cast<int>(inliers.size()) < kMinInliers) return std::nullopt;
  Pose X_KC = to_pose(rotation, translation).inverse();
  if (!X_KC.matrix().allFinite()) return std::nullopt;
  return X_KC;
}

}  // namespace kintsugi::mapper
