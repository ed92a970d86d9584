#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <opencv2/imgproc.hpp>

#include "mapper/core/fusion/raycaster.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

using testing::camera_of;
using testing::fuse;
using ::testing::HasSubstr;
using testing::percentile;
using ::testing::ThrowsMessage;
using testing::View;

constexpr double kResolution_m = 0.01;

TsdfVolume::Config volume_of(double size_m) {
  return {.region = RegionShape::kCube, .volume_size_m = size_m, .resolution_m = kResolution_m};
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

/// A raycast against a rendered picture of the same view, over the pixels that are away from
/// silhouettes and see their surface at less than 75 degrees from its normal.
struct Comparison {
  double hole_share = 0.0;
  std::vector<double> depth_error_vox;
  std::vector<double> normal_error_deg;
};

Comparison compare(const SurfaceMap& surface, const synthetic::RenderedFrame& truth) {
  cv::Mat_<float> lowest;
  cv::Mat_<float> highest;
  const cv::Mat kernel = cv::Mat::ones(5, 5, CV_8U);
  cv::erode(truth.depth_m, lowest, kernel);
  cv::dilate(truth.depth_m, highest, kernel);
  Comparison result;
  int num_compared = 0;
  int num_holes = 0;
  const Eigen::Matrix3d R_CW = truth.X_WC.linear().transpose();
  for (int v = 2; v < truth.depth_m.rows - 2; ++v) {
    for (int u = 2; u < truth.depth_m.cols - 2; ++u) {
      const cv::Vec3f& n_W = truth.normals_W(v, u);
      const Eigen::Vector3d normal_C = R_CW * Eigen::Vector3d(n_W[0], n_W[1], n_W[2]);
      const Eigen::Vector3d ray_C((u - truth.intrinsics.cx) / truth.intrinsics.fx,
                                  (v - truth.intrinsics.cy) / truth.intrinsics.fy, 1.0);
      const bool is_smooth = highest(v, u) - lowest(v, u) < 0.1F;
      if (!is_smooth || -normal_C.dot(ray_C.normalized()) < std::cos(75 * M_PI / 180)) continue;
      ++num_compared;
      const float depth_m = surface.depth_m(v, u);
      const Eigen::Vector3d n_C = surface.normal(v, u).cast<double>();
      if (std::isnan(depth_m) || std::isnan(n_C.z())) {
        ++num_holes;
        continue;
      }
      result.depth_error_vox.push_back(std::abs(depth_m - truth.depth_m(v, u)) / kResolution_m);
      result.normal_error_deg.push_back(std::acos(std::min(normal_C.dot(n_C), 1.0)) * 180.0 / M_PI);
    }
  }
  result.hole_share = static_cast<double>(num_holes) / num_compared;
  return result;
}

/// The box room, fused along a path.
class RaycastRoom : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new synthetic::SceneWithPath(synthetic::make_scene_with_path("box-room"));
    const std::vector<View> views = testing::views_along_path(*scene_, 40);
    volume_ = new TsdfVolume(volume_of(4.8), {0.0, 0.0, 1.25});  // holds the whole room
    fuse(views, *volume_);
  }
  static void TearDownTestSuite() {
    delete volume_;
    delete scene_;
  }
  /// On the path, not where a frame was fused.
  static Pose X_WC() { return scene_->trajectory.X_WC(0.37 * scene_->trajectory.duration_s()); }
  static synthetic::RenderedFrame truth(const Intrinsics& camera) {
    return synthetic::render(scene_->scene, camera, X_WC());
  }

  static synthetic::SceneWithPath* scene_;
  static TsdfVolume* volume_;
};
synthetic::SceneWithPath* RaycastRoom::scene_ = nullptr;
TsdfVolume* RaycastRoom::volume_ = nullptr;

TEST_F(RaycastRoom, SeesWhatTheRendererSees) {
  for (const Intrinsics& camera : {camera_of(320, 240), camera_of(161, 119)}) {
    const auto c = compare(Raycaster({}).raycast(*volume_, X_WC(), camera), truth(camera));
    EXPECT_LT(c.hole_share, 0.001);
    // Along a ray that meets a wall at 60 degrees an error of a tenth of a voxel doubles.
    EXPECT_LT(percentile(c.depth_error_vox, 0.5), 0.1);
    EXPECT_LT(percentile(c.depth_error_vox, 0.95), 0.5);
    EXPECT_LT(percentile(c.normal_error_deg, 0.5), 1.0);
    EXPECT_LT(percentile(c.normal_error_deg, 0.9), 10.0);  // edges are rounded over two voxels
  }
}

TEST_F(RaycastRoom, SeesTheSameWithAGuide) {
  const Intrinsics camera = camera_of(320, 240);
  const SurfaceMap unguided = Raycaster({}).raycast(*volume_, X_WC(), camera);
  const cv::Mat_<float> guide_m = truth(camera_of(640, 480)).depth_m;
  const auto c = compare(Raycaster({}).raycast(*volume_, X_WC(), camera, guide_m), truth(camera));
  EXPECT_LT(c.hole_share, 0.001);
  EXPECT_LT(percentile(c.depth_error_vox, 0.95), 0.5);

  // A guide from elsewhere, or with nothing in it, loses no surface.
  cv::Mat_<float> bad_guide_m(480, 640, std::numeric_limits<float>::quiet_NaN());
  bad_guide_m.rowRange(0, 100).setTo(50.0F);
  bad_guide_m.rowRange(100, 200).setTo(-1.0F);
  bad_guide_m.rowRange(200, 300).setTo(std::numeric_limits<float>::infinity());
  EXPECT_TRUE(same_bytes(Raycaster({}).raycast(*volume_, X_WC(), camera, bad_guide_m).depth_m,
                         unguided.depth_m));
  bad_guide_m.setTo(4.4F);
  EXPECT_EQ(
      cv::countNonZero(Raycaster({}).raycast(*volume_, X_WC(), camera, bad_guide_m).depth_m > 0),
      cv::countNonZero(unguided.depth_m > 0));
}

TEST_F(RaycastRoom, GivesUnitNormalsThatFaceTheCamera) {
  const Intrinsics camera = camera_of(160, 120);
  const SurfaceMap surface = Raycaster({}).raycast(*volume_, X_WC(), camera);
  EXPECT_EQ(surface.intrinsics, camera);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3f n = surface.normal(v, u);
      if (std::isnan(n.x())) continue;
      ASSERT_NEAR(n.norm(), 1.0, 1e-5);
      ASSERT_LT(n.dot(surface.point(v, u)), 0.0F);
    }
  }
}

TEST_F(RaycastRoom, DoesNotDependOnTheNumberOfThreads) {
  const Intrinsics camera = camera_of(160, 120);
  const SurfaceMap parallel = Raycaster({}).raycast(*volume_, X_WC(), camera);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const SurfaceMap serial = Raycaster({}).raycast(*volume_, X_WC(), camera);
  EXPECT_TRUE(same_bytes(parallel.depth_m, serial.depth_m));
  EXPECT_TRUE(same_bytes(parallel.normal_x, serial.normal_x));
  EXPECT_TRUE(same_bytes(parallel.normal_y, serial.normal_y));
  EXPECT_TRUE(same_bytes(parallel.normal_z, serial.normal_z));
}

TEST_F(RaycastRoom, EndsAtItsRange) {
  const Intrinsics camera = camera_of(160, 120);
  const cv::Mat_<float> all_m = Raycaster({}).raycast(*volume_, X_WC(), camera).depth_m;
  const cv::Mat_<float> near_m =
      Raycaster({.max_depth_m = 1.5}).raycast(*volume_, X_WC(), camera).depth_m;
  EXPECT_GT(cv::countNonZero(all_m > 1.6F), 0);
  EXPECT_EQ(cv::countNonZero(near_m > 1.6F), 0);
}

TEST(Raycaster, SeesASphereWithoutHoles) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume(volume_of(1.6));
  fuse(testing::views_around(scene, 1.3, {-0.9, -0.3, 0.3, 0.9}, 8), volume);
  const Intrinsics camera = camera_of(320, 240);
  const Pose X_WC = synthetic::look_at({0.9, -0.8, 0.4}, {0.0, 0.0, 0.0});
  const auto c =
      compare(Raycaster({}).raycast(volume, X_WC, camera), synthetic::render(scene, camera, X_WC));
  EXPECT_EQ(c.hole_share, 0.0);
  EXPECT_LT(percentile(c.depth_error_vox, 0.5), 0.1);
  EXPECT_LT(percentile(c.depth_error_vox, 0.99), 0.5);
  // Neighbouring pixels are half a voxel apart here, and a distance is off by a tenth.
  EXPECT_LT(percentile(c.normal_error_deg, 0.5), 5.0);
}

TEST(Raycaster, SeesNothingInAnEmptyVolume) {
  const TsdfVolume volume(volume_of(1.6));
  const SurfaceMap surface = Raycaster({}).raycast(volume, Pose::Identity(), camera_of(160, 120),
                                                   cv::Mat_<float>(120, 160, 1.0F));
  ASSERT_EQ(surface.depth_m.size(), cv::Size(160, 120));
  for (const cv::Mat_<float>* plane :
       {&surface.depth_m, &surface.normal_x, &surface.normal_y, &surface.normal_z}) {
    for (const float value : *plane) ASSERT_TRUE(std::isnan(value));
  }
}

TEST(Raycaster, SeesTheCubeFromOutsideAndFarFromTheOrigin) {
  // A wall 2 m before a camera that is 1.5 km from the origin, in a cube that holds only the wall.
  Pose X_WC = Pose::Identity();
  X_WC.translation() << 1000.0, -1000.0, 500.0;
  View view;
  view.frame.intrinsics = camera_of(160, 120);
  view.frame.depth_m = cv::Mat_<float>(120, 160, 2.0F);
  TsdfVolume volume(volume_of(0.8), X_WC * Eigen::Vector3d(0.0, 0.0, 2.0));
  Integrator({}).integrate(view.frame, X_WC, volume);
  const SurfaceMap surface = Raycaster({}).raycast(volume, X_WC, camera_of(160, 120));
  EXPECT_NEAR(surface.depth_m(60, 80), 2.0, 0.02 * kResolution_m);
  EXPECT_TRUE(std::isnan(surface.depth_m(2, 2))) << "outside the cube";
  Pose turned = X_WC;
  turned.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_TRUE(
      std::isnan(Raycaster({}).raycast(volume, turned, camera_of(160, 120)).depth_m(60, 80)));
}

TEST(Raycaster, RefusesWhatCannotWork) {
  EXPECT_THAT([] { Raycaster raycaster({.min_depth_m = 0.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("min_depth_m is 0")));
  EXPECT_THAT([] { Raycaster raycaster({.min_depth_m = 2.0, .max_depth_m = 1.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("max_depth_m is 1")));
  const TsdfVolume volume(volume_of(0.8));
  EXPECT_THROW(Raycaster({}).raycast(volume, Pose::Identity(), {}), std::invalid_argument);
  Pose nowhere = Pose::Identity();
  nowhere.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Raycaster({}).raycast(volume, nowhere, camera_of(160, 120)), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
