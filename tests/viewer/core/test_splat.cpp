#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/core/map/received_map.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {
namespace {

constexpr float kResolution_m = 0.01F;

CloudPoint point(float x, float y, float z, const Eigen::Vector3f& normal) {
  CloudPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.nx = normal.x();
  p.ny = normal.y();
  p.nz = normal.z();
  return p;
}

CloudPoint facing(float x, float y, float z) { return point(x, y, z, {0.0F, 0.0F, -1.0F}); }

ReceivedMap map_of(std::vector<CloudPoint> points, float resolution_m = kResolution_m) {
  CloudSlice slice;
  slice.session = 1;
  slice.resolution_m = resolution_m;
  slice.points_W = std::move(points);
  ReceivedMap map(1);
  map.add_slice(std::move(slice));
  return map;
}

/// V at W's origin with W's axes; 90 degrees wide.
VirtualCamera camera_at_origin(int width, int height) {
  return {pinhole(width, height, std::numbers::pi / 2.0), Pose::Identity()};
}

/// The definition in splat.hpp, point by point and pixel by pixel, in double precision.
struct Reference {
  double depth_m = INFINITY;
  std::size_t point = 0;
};

std::size_t pixel_index(const Intrinsics& k, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(k.width) +
         static_cast<std::size_t>(u);
}

std::vector<Reference> reference_picture(const std::vector<CloudPoint>& points,
                                         const VirtualCamera& camera, const SplatConfig& config) {
  const Intrinsics& k = camera.intrinsics;
  const double radius_m = config.radius_vox * kResolution_m;
  std::vector<Reference> picture(pixel_index(k, 0, k.height));
  const auto keep = [&](int u, int v, double depth_m, std::size_t i) {
    Reference& pixel = picture[pixel_index(k, u, v)];
    if (depth_m < pixel.depth_m) pixel = {depth_m, i};
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CloudPoint& q = points[i];
    const Eigen::Vector3d p = camera.X_WV.inverse() * Eigen::Vector3d(q.x, q.y, q.z);
    const Eigen::Vector3d n = camera.X_WV.linear().transpose() * Eigen::Vector3d(q.nx, q.ny, q.nz);
    if (p.dot(n) >= 0.0 || p.z() < config.near_m) continue;
    const auto u = static_cast<int>(std::lround(k.fx * p.x() / p.z() + k.cx));
    const auto v = static_cast<int>(std::lround(k.fy * p.y() / p.z() + k.cy));
    if (u >= 0 && u < k.width && v >= 0 && v < k.height) keep(u, v, p.z(), i);
    if (k.fx * radius_m / p.z() < 0.5) continue;
    for (int y = 0; y < k.height; ++y) {
      for (int x = 0; x < k.width; ++x) {
        const Eigen::Vector3d ray((x - k.cx) / k.fx, (y - k.cy) / k.fy, 1.0);
        const double depth_m = n.dot(p) / n.dot(ray);
        const double distance2_m2 = (ray * depth_m - p).squaredNorm();
        if (depth_m > 0.0 && distance2_m2 <= radius_m * radius_m) {
          keep(x, y, depth_m + 0.25 * distance2_m2 / radius_m, i);
        }
      }
    }
  }
  return picture;
}

TEST(Splat, FindsInEachPixelWhatASearchOverAllPointsFinds) {
  constexpr int kWidth = 64;
  constexpr int kHeight = 48;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-0.2F, 0.2F);
  std::normal_distribution<float> direction;
  std::vector<CloudPoint> points;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3f n(direction(random), direction(random), direction(random));
    points.push_back(
        point(coordinate(random), coordinate(random), 0.4F + coordinate(random), n.normalized()));
  }
  VirtualCamera camera = camera_at_origin(kWidth, kHeight);
  camera.X_WV = look_at({0.05, -0.1, -0.2}, {0.0, 0.0, 0.4}, {0.0, -1.0, 0.0});
  const SplatConfig config{.radius_vox = 2.0, .max_radius_px = 1000.0};

  const ReceivedMap map = map_of(points);
  const VisibilityImage found = splat_points(map.chunks(0), camera, config);
  const std::vector<Reference> expected = reference_picture(points, camera, config);

  // A ray that meets the rim of a disc within the rounding of single precision may fall on either
  // side of it: that is one pixel in a thousand here.
  int different = 0;
  int drawn = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Reference& pixel = expected[pixel_index(camera.intrinsics, u, v)];
      const bool empty = std::isinf(pixel.depth_m);
      drawn += empty ? 0 : 1;
      const bool same = found.empty(u, v)
                            ? empty
                            : !empty && found.point(u, v) == pixel.point &&
                                  std::abs(found.depth_m(u, v) - pixel.depth_m) < 1e-5;
      different += same ? 0 : 1;
    }
  }
  EXPECT_GT(drawn, 250);
  EXPECT_LE(different, 3);
}

TEST(Splat, ProjectsAPointWhereThePinholeModelSays) {
  const VirtualCamera camera = camera_at_origin(101, 101);  // f = 50.5, c = 50
  // u = 50.5 * 0.4 / 2 + 50 = 60.1, v = 50.5 * -0.2 / 2 + 50 = 44.95; radius 0.25 px.
  const ReceivedMap map = map_of({facing(0.4F, -0.2F, 2.0F)});
  const VisibilityImage image = splat_points(map.chunks(0), camera, {});
  for (int v = 0; v < 101; ++v) {
    for (int u = 0; u < 101; ++u) EXPECT_EQ(image.empty(u, v), u != 60 || v != 45);
  }
  EXPECT_FLOAT_EQ(2.0F, image.depth_m(60, 45));
}

TEST(Splat, LeavesNoHoleInASampledPlane) {
  // Points on a square grid of one voxel: no place on the plane is farther than 1/sqrt(2) voxel
  // from one, so discs of 0.72 voxel cover it, seen from anywhere in front of it.
  std::vector<CloudPoint> points;
  for (int i = -100; i <= 100; ++i) {
    for (int j = -100; j <= 100; ++j) {
      points.push_back(facing(kResolution_m * static_cast<float>(i),
                              kResolution_m * static_cast<float>(j), 0.0F));
    }
  }
  const ReceivedMap map = map_of(points);
  const SplatConfig config{.radius_vox = 0.72, .max_radius_px = 1000.0};
  for (const Eigen::Vector3d& eye_W :
       {Eigen::Vector3d(0.0, 0.0, -0.3), Eigen::Vector3d(0.3, 0.2, -0.2),
        Eigen::Vector3d(0.7, 0.0, -0.1), Eigen::Vector3d(0.0, 0.5, -1.0)}) {
    const VirtualCamera camera{pinhole(160, 120, 0.9),
                               look_at(eye_W, Eigen::Vector3d::Zero(), {0.0, -1.0, 0.0})};
    const VisibilityImage image = splat_points(map.chunks(0), camera, config);
    const Intrinsics& k = camera.intrinsics;
    const auto plane_depth_m = [&](double u, double v) {
      const Eigen::Vector3d ray_V((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1.0);
      return -eye_W.z() / (camera.X_WV.linear() * ray_V).z();
    };
    int inside = 0;
    for (int v = 0; v < k.height; ++v) {
      for (int u = 0; u < k.width; ++u) {
        const double depth_m = plane_depth_m(u, v);
        const Eigen::Vector3d p_V((u - k.cx) / k.fx * depth_m, (v - k.cy) / k.fy * depth_m,
                                  depth_m);
        if (depth_m <= 0.0 || (camera.X_WV * p_V).cwiseAbs().maxCoeff() > 0.99) continue;
        ++inside;
        ASSERT_FALSE(image.empty(u, v)) << u << ", " << v;
        // A disc bulges by up to a quarter of its radius; the pixel of a point's centre has the
        // depth of that point, which lies up to half a pixel away.
        double slope_m = 0.0;
        for (const double du : {-0.5, 0.5}) {
          for (const double dv : {-0.5, 0.5}) {
            slope_m = std::max(slope_m, std::abs(plane_depth_m(u + du, v + dv) - depth_m));
          }
        }
        EXPECT_NEAR(depth_m, image.depth_m(u, v), 0.0018 + slope_m + 1e-5);
      }
    }
    EXPECT_GT(inside, 5000);
  }
}

TEST(Splat, DrawsTheNearerOfTwoAndOfEqualsTheFirst) {
  const VirtualCamera camera = camera_at_origin(11, 11);
  const ReceivedMap map = map_of({facing(0.0F, 0.0F, 3.0F), facing(0.0F, 0.0F, 2.0F),
                                  facing(0.0F, 0.0F, 2.0F), facing(0.0F, 0.0F, 2.5F)});
  const VisibilityImage image = splat_points(map.chunks(0), camera, {});
  EXPECT_EQ(1U, image.point(5, 5));
}

TEST(Splat, CullsBackFacesAndWhatIsBehindOrNotANumber) {
  const VirtualCamera camera = camera_at_origin(11, 11);
  const Eigen::Vector3f away(0.0F, 0.0F, 1.0F);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto drawn = [&](const CloudPoint& p, const SplatConfig& config = {}) {
    const ReceivedMap map = map_of({p});
    return !splat_points(map.chunks(0), camera, config).empty(5, 5);
  };
  EXPECT_TRUE(drawn(facing(0.0F, 0.0F, 2.0F)));
  EXPECT_FALSE(drawn(point(0.0F, 0.0F, 2.0F, away)));
  EXPECT_TRUE(drawn(point(0.0F, 0.0F, 2.0F, away), {.cull_back_faces = false}));
  EXPECT_TRUE(drawn(point(0.0F, 0.0F, 2.0F, Eigen::Vector3f::Zero())));
  EXPECT_FALSE(drawn(facing(0.0F, 0.0F, -2.0F)));
  EXPECT_FALSE(drawn(facing(0.0F, 0.0F, 0.01F)));
  EXPECT_FALSE(drawn(facing(0.0F, 0.0F, nan)));
  EXPECT_FALSE(drawn(facing(nan, 0.0F, 2.0F)));
}

TEST(Splat, SkipsNoChunkThatReachesIntoThePicture) {
  // One chunk per slice; a chunk is culled by its box, so drawing all points as one big chunk whose
  // box is everything must give the same picture.
  const SyntheticMap room = make_room(4.0, 0.05);
  ReceivedMap by_slice(1'000);
  for (const CloudSlice& slice : room.slices) by_slice.add_slice(slice);
  for (const double yaw_rad : {0.0, 1.0, 2.5, 4.0, 5.5}) {
    VirtualCamera camera{pinhole(120, 90, 0.9), Pose::Identity()};
    camera.X_WV.linear() = look_down({0.0, -1.0, 0.0}, yaw_rad, 0.3);
    camera.X_WV.translation() = Eigen::Vector3d(0.2, 0.1, 2.0);
    std::vector<PointChunk> chunks = by_slice.chunks(0);
    const VisibilityImage culled = splat_points(chunks, camera, {});
    Eigen::AlignedBox3f box_W;
    for (const PointChunk& chunk : chunks) box_W.extend(chunk.box_W);
    for (PointChunk& chunk : chunks) chunk.box_W = box_W;
    const VisibilityImage all = splat_points(chunks, camera, {});
    for (int v = 0; v < 90; ++v) {
      for (int u = 0; u < 120; ++u) ASSERT_EQ(all.at(u, v), culled.at(u, v));
    }
  }
}

TEST(Splat, DrawsTheSameOnAnyNumberOfThreads) {
  const SyntheticMap room = make_room(4.0, 0.03);
  ReceivedMap map(1'000);
  for (const CloudSlice& slice : room.slices) map.add_slice(slice);
  const VirtualCamera camera{pinhole(320, 200, 0.9),
                             look_at({0.5, -2.0, -3.0}, {0.0, 0.0, 2.0}, {0.0, -1.0, 0.0})};
  const auto draw = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return splat_points(map.chunks(0), camera, {});
  };
  const VisibilityImage one = draw(1);
  const VisibilityImage four = draw(4);
  for (int v = 0; v < 200; ++v) {
    for (int u = 0; u < 320; ++u) ASSERT_EQ(one.at(u, v), four.at(u, v));
  }
}

TEST(Splat, RefusesAConfigurationOutOfItsBounds) {
  EXPECT_NO_THROW(SplatConfig{}.validate());
  EXPECT_THROW(SplatConfig{.radius_vox = 0.0}.validate(), std::invalid_argument);
  EXPECT_THROW(SplatConfig{.radius_vox = NAN}.validate(), std::invalid_argument);
  EXPECT_THROW(SplatConfig{.max_radius_px = 0.0}.validate(), std::invalid_argument);
  EXPECT_THROW(SplatConfig{.near_m = -1.0}.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::viewer
