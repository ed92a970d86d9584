#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"

namespace kintsugi::synthetic {
namespace {

using Eigen::Vector3d;

Vector3d ray_C(const Intrinsics& camera, int u, int v) {
  return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
}

template <typename Pixel>
bool same_bytes(const cv::Mat_<Pixel>& a, const cv::Mat_<Pixel>& b) {
  return a.size() == b.size() && std::equal(a.datastart, a.dataend, b.datastart, b.dataend);
}

TEST(Renderer, PlaneSeenFromAboveHasItsClosedFormDepth) {
  constexpr double kTolerance_m = 2e-6;  // float near 1.5 m: 1.2e-7 m a step
  Pose X_WC = Pose::Identity();
  X_WC.linear() = Eigen::AngleAxisd(std::acos(-1.0), Vector3d::UnitX()).toRotationMatrix();
  X_WC.translation() = Vector3d(0.1, -0.2, 1.5);  // looks straight down on z = 0
  const RenderedFrame frame = render(make_scene("plane"), default_intrinsics(), X_WC);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      ASSERT_NEAR(frame.depth_m(v, u), 1.5, kTolerance_m);
      ASSERT_EQ(frame.normals_W(v, u), cv::Vec3f(0, 0, 1));
    }
  }
}

TEST(Renderer, SphereHasItsClosedFormDepthAndEmptySpaceIsMarked) {
  constexpr double kTolerance_m = 2e-5;
  const Intrinsics camera = default_intrinsics();
  const Pose X_WC = look_at({0, -1.5, 0}, {0, 0, 0});
  const RenderedFrame frame = render(make_scene("sphere"), camera, X_WC);
  for (int v = 0; v < 480; v += 3) {
    for (int u = 0; u < 640; u += 3) {
      const Vector3d d = ray_C(camera, u, v);
      const Vector3d to_camera(0, 0, -1.5);  // from the centre, in C
      const double a = d.squaredNorm();
      const double b = d.dot(to_camera);
      const double discriminant = b * b - a * (1.5 * 1.5 - 0.25);
      if (std::abs(discriminant) < 0.01) continue;  // the outline
      if (discriminant < 0) {
        EXPECT_TRUE(std::isnan(frame.depth_m(v, u)));
        EXPECT_EQ(frame.instances(v, u), kNoInstance);
        EXPECT_EQ(frame.normals_W(v, u), cv::Vec3f(0, 0, 0));
        continue;
      }
      const double t = (-b - std::sqrt(discriminant)) / a;
      EXPECT_NEAR(frame.depth_m(v, u), t, kTolerance_m);
      const Vector3d normal_W = X_WC * (t * d) / 0.5;
      const cv::Vec3f n = frame.normals_W(v, u);
      EXPECT_NEAR((Vector3d(n[0], n[1], n[2]) - normal_W).norm(), 0.0, 1e-4);
    }
  }
}

/// The scene's own ray through (u, v): in double precision and through the tree.
std::optional<RayHit> scene_ray(const Scene& scene, const RenderedFrame& frame, double u,
                                double v) {
  const Intrinsics& camera = frame.intrinsics;
  const Vector3d direction_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
  return scene.intersect(frame.X_WC.translation(), frame.X_WC.linear() * direction_C);
}

/// On a surface seen flat, an error across it is a larger one along the ray.
bool agrees(const RenderedFrame& frame, int u, int v, const std::optional<RayHit>& hit) {
  constexpr double kTolerance_m = 2e-5;
  if (!hit) return frame.instances(v, u) == kNoInstance;
  const Vector3d ray_W = hit->p_W - frame.X_WC.translation();
  const double cosine = -hit->normal_W.dot(ray_W.normalized());
  return frame.instances(v, u) == hit->instance &&
         std::abs(frame.depth_m(v, u) - hit->t) < kTolerance_m / std::max(cosine, 0.01);
}

TEST(Renderer, AgreesWithTheRaysOfTheScene) {
  // Single precision may take the other side of an edge or an outline that is this
  // near to the pixel's centre.
  constexpr double kEdge_px = 0.005;
  for (const std::string& name : scene_names()) {
    const SceneWithPath content = make_scene_with_path(name);
    for (double share : {0.0, 0.35, 0.7, 1.0}) {
      const Pose X_WC = content.trajectory.X_WC(share * content.trajectory.duration_s());
      const RenderedFrame frame = render(content.scene, default_intrinsics(), X_WC);
      for (int v = 1; v < 480; v += 7) {
        for (int u = 2; u < 640; u += 7) {
          bool same = agrees(frame, u, v, scene_ray(content.scene, frame, u, v));
          for (double du : {-kEdge_px, kEdge_px}) {
            for (double dv : {-kEdge_px, kEdge_px}) {
              if (same) break;
              const auto beside = scene_ray(content.scene, frame, u + du, v + dv);
              same = (beside ? beside->instance : kNoInstance) == frame.instances(v, u);
            }
          }
          EXPECT_TRUE(same) << name << " pixel " << u << ' ' << v << " depth "
                            << frame.depth_m(v, u) << " instance " << frame.instances(v, u);
        }
      }
    }
  }
}

TEST(Renderer, PicturesAreTheSameOnAnyNumberOfThreads) {
  const SceneWithPath content = make_scene_with_path("office");
  const Pose X_WC = content.trajectory.X_WC(3.0);
  const RenderedFrame two = render(content.scene, default_intrinsics(), X_WC);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const RenderedFrame one = render(content.scene, default_intrinsics(), X_WC);
  EXPECT_TRUE(same_bytes(one.depth_m, two.depth_m));
  EXPECT_TRUE(same_bytes(one.color_rgb, two.color_rgb));
  EXPECT_TRUE(same_bytes(one.normals_W, two.normals_W));
  EXPECT_TRUE(same_bytes(one.instances, two.instances));
}

// What a segmentation is scored on: it has to be in the camera's view, and not only as a speck.
TEST(Renderer, OfficeShowsAtLeastEightyObjectsOnItsPath) {
  constexpr int kMinPixels = 400;  // an eighth of a percent of the picture
  const SceneWithPath content = make_scene_with_path("office");
  std::vector<int> most_pixels(content.scene.instances().size() + 1, 0);
  for (double t_s = 0; t_s <= content.trajectory.duration_s(); t_s += 1.5) {
    const RenderedFrame frame =
        render(content.scene, default_intrinsics(), content.trajectory.X_WC(t_s));
    std::vector<int> pixels(most_pixels.size(), 0);
    for (const std::uint16_t id : frame.instances) ++pixels.at(id);
    for (std::size_t id = 0; id < pixels.size(); ++id) {
      most_pixels[id] = std::max(most_pixels[id], pixels[id]);
    }
  }
  int num_seen = 0;
  std::set<std::string> kinds;
  for (const Instance& instance : content.scene.instances()) {
    if (instance.is_structure || most_pixels.at(instance.id) < kMinPixels) continue;
    ++num_seen;
    kinds.insert(instance.name);
  }
  EXPECT_GE(num_seen, 80);
  EXPECT_GE(kinds.size(), 40U) << "not only books";
}

TEST(Renderer, OddImageSizesAreWholeAndAgreeWithTheLargerPicture) {
  const SceneWithPath content = make_scene_with_path("box-room");
  Intrinsics camera = default_intrinsics();
  const RenderedFrame whole = render(content.scene, camera, content.trajectory.X_WC(0));
  camera.width = 101;
  camera.height = 37;
  const RenderedFrame corner = render(content.scene, camera, content.trajectory.X_WC(0));
  EXPECT_TRUE(
      same_bytes(corner.depth_m, cv::Mat_<float>(whole.depth_m(cv::Rect(0, 0, 101, 37)).clone())));
}

TEST(Renderer, BadIntrinsicsAreRefused) {
  const Scene scene = make_scene("plane");
  Intrinsics camera = default_intrinsics();
  camera.fx = 0;
  EXPECT_THROW(render(scene, camera, Pose::Identity()), std::invalid_argument);
  camera = default_intrinsics();
  camera.width = -1;
  EXPECT_THROW(render(scene, camera, Pose::Identity()), std::invalid_argument);
  camera = default_intrinsics();
  camera.distortion[0] = 0.1;
  EXPECT_THROW(render(scene, camera, Pose::Identity()), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
