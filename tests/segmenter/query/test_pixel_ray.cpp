// The ray of a pixel; and through it, in a synthetic room, the object that is truly there.

#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "mapper/synthetic/rooms/scenes.hpp"
#include "segmenter/query/pixel_ray.hpp"

namespace kintsugi::segmenter {
namespace {

Pose example_X_WC() {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X_WC.translation() << 1.0, -2.0, 0.5;
  return X_WC;
}

TEST(PixelRay, PassesThroughThePointThatThePixelShows) {
  const Intrinsics kinect = kinect_intrinsics();
  const Pose X_WC = example_X_WC();
  const Eigen::Vector3d p_C(0.4, -0.3, 1.7);
  const Ray ray = pixel_ray(kinect, X_WC, kinect.fx * p_C.x() / p_C.z() + kinect.cx,
                            kinect.fy * p_C.y() / p_C.z() + kinect.cy);
  EXPECT_EQ(ray.origin_W, X_WC.translation());
  EXPECT_NEAR(ray.direction_W.norm(), 1.0, 1e-12);
  EXPECT_TRUE((ray.origin_W + p_C.norm() * ray.direction_W).isApprox(X_WC * p_C, 1e-12));
}

TEST(PixelRay, TakesTheLensOut) {
  Intrinsics lens = kinect_intrinsics();
  lens.distortion = {0.12, -0.25, 0.002, -0.001, 0.09};
  const auto [k1, k2, p1, p2, k3] = lens.distortion;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> slope(-0.4, 0.4);
  for (int trial = 0; trial < 100; ++trial) {
    const double x = slope(random);
    const double y = slope(random);
    const double r2 = x * x + y * y;
    const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
    // OpenCV's documentation of the model.
    const double u = lens.fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + lens.cx;
    const double v = lens.fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + lens.cy;
    const Ray ray = pixel_ray(lens, Pose::Identity(), u, v);
    // The iteration ends within 1e-9 on the image plane, some times that where it is steep.
    EXPECT_NEAR(ray.direction_W.x() / ray.direction_W.z(), x, 1e-8);
    EXPECT_NEAR(ray.direction_W.y() / ray.direction_W.z(), y, 1e-8);
  }
}

TEST(PixelRay, RefusesWhatIsNoPixel) {
  const Intrinsics kinect = kinect_intrinsics();
  EXPECT_NO_THROW(pixel_ray(kinect, Pose::Identity(), -0.5, 479.5));
  EXPECT_THROW(pixel_ray(kinect, Pose::Identity(), -0.6, 10), std::invalid_argument);
  EXPECT_THROW(pixel_ray(kinect, Pose::Identity(), 10, 480), std::invalid_argument);
  EXPECT_THROW(pixel_ray(kinect, Pose::Identity(), std::nan(""), 0), std::invalid_argument);
  Intrinsics absurd = kinect;
  absurd.distortion = {-100, 0, 0, 0, 0};
  EXPECT_THROW(pixel_ray(absurd, Pose::Identity(), 0, 0), std::invalid_argument);
}

// A map in which every instance of the room is one segment: what the camera saw from some places
// of its path, one point for each voxel.
class SeenRoom : public ::testing::Test {
 protected:
  static constexpr double kVoxel_m = 0.02;
  static constexpr double kViewEvery_s = 1.0;
  static constexpr int kNumViews = 6;

  SeenRoom() : room_(synthetic::make_scene_with_path("office")) {
    for (int view = 0; view < kNumViews; ++view) add_view(X_WC(view));
  }

  [[nodiscard]] Pose X_WC(int view) const { return room_.trajectory.X_WC(kViewEvery_s * view); }
  [[nodiscard]] std::optional<synthetic::RayHit> truth(const Ray& ray) const {
    return room_.scene.intersect(ray.origin_W, ray.direction_W);
  }
  [[nodiscard]] LabelledCloud cloud() const {
    return {points_W_, instances_, static_cast<float>(kVoxel_m),
            static_cast<float>(2.0 * kVoxel_m)};
  }
  [[nodiscard]] std::uint32_t instance_at(const Ray& ray) const {
    const auto hit = visible_point(cloud(), ray, 2.0 * kVoxel_m);
    return hit ? instances_[hit->point] : kNoSegment;
  }

  const Intrinsics camera_ = kinect_intrinsics();

 private:
  void add_view(const Pose& X_WC) {
    constexpr int kStep_px = 2;
    for (int v = 0; v < camera_.height; v += kStep_px) {
      for (int u = 0; u < camera_.width; u += kStep_px) {
        const auto hit = truth(pixel_ray(camera_, X_WC, u, v));
        if (hit && is_new(hit->p_W)) add(*hit);
      }
    }
  }
  bool is_new(const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d cell = (p_W / kVoxel_m).array().floor();
    return cells_.emplace(std::tuple(cell.x(), cell.y(), cell.z()), true).second;
  }
  void add(const synthetic::RayHit& hit) {
    CloudPoint point;
    point.x = static_cast<float>(hit.p_W.x());
    point.y = static_cast<float>(hit.p_W.y());
    point.z = static_cast<float>(hit.p_W.z());
    point.nx = static_cast<float>(hit.normal_W.x());
    point.ny = static_cast<float>(hit.normal_W.y());
    point.nz = static_cast<float>(hit.normal_W.z());
    points_W_.push_back(point);
    instances_.push_back(static_cast<std::uint32_t>(hit.instance));
  }

  synthetic::SceneWithPath room_;
  std::map<std::tuple<double, double, double>, bool> cells_;
  std::vector<CloudPoint> points_W_;
  std::vector<std::uint32_t> instances_;
};

TEST_F(SeenRoom, PixelsShowTheInstanceThatIsThere) {
  int seen = 0;
  int right = 0;
  int right_off_edges = 0;
  int off_edges = 0;
  std::mt19937 random(2);
  for (int trial = 0; trial < 600; ++trial) {
    const Pose pose = X_WC(static_cast<int>(random() % kNumViews));
    const int u = 20 + static_cast<int>(random() % 600);
    const int v = 20 + static_cast<int>(random() % 440);
    const Ray ray = pixel_ray(camera_, pose, u, v);
    const auto there = truth(ray);
    if (!there) continue;
    ++seen;
    const bool is_right = instance_at(ray) == static_cast<std::uint32_t>(there->instance);
    right += is_right ? 1 : 0;
    // A voxel and a half, as many pixels as it takes at this depth: nearer to its outline an object
    // and what is behind it cannot be told apart in a map of points.
    const double margin_px = 1.5 * kVoxel_m * camera_.fx / there->t;
    bool is_off_edge = true;
    for (const auto& [du, dv] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}}) {
      const double u_beside = std::clamp(u + margin_px * du, 0.0, 639.0);
      const double v_beside = std::clamp(v + margin_px * dv, 0.0, 479.0);
      const auto beside = truth(pixel_ray(camera_, pose, u_beside, v_beside));
      is_off_edge = is_off_edge && beside && beside->instance == there->instance;
    }
    off_edges += is_off_edge ? 1 : 0;
    right_off_edges += is_off_edge && is_right ? 1 : 0;
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(off_edges, 300);
  EXPECT_GE(right, seen * 9 / 10);
  EXPECT_GE(right_off_edges, off_edges * 99 / 100);
}

}  // namespace
}  // namespace kintsugi::segmenter
