#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/volume/detached_blocks.hpp"
#include "tests/mapper/core/exact_volume.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

using testing::fuse;
using ::testing::HasSubstr;
using testing::percentile;
using ::testing::ThrowsMessage;
using testing::View;

using Cloud = std::vector<CloudPoint>;

constexpr double kResolution_m = 0.01;

TsdfVolume::Config volume_of(double size_m) {
  return {.region = RegionShape::kCube, .volume_size_m = size_m, .resolution_m = kResolution_m};
}

Cloud extract(const DetachedBlocks& blocks, int weight_threshold = 0) {
  return SurfaceExtractor({.weight_threshold = weight_threshold}).extract(blocks);
}

Eigen::Vector3d position_W(const CloudPoint& p) { return {p.x, p.y, p.z}; }
Eigen::Vector3d normal_W(const CloudPoint& p) { return {p.nx, p.ny, p.nz}; }

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180.0 / M_PI;
}

template <typename Function>
std::vector<double> map(const Cloud& points, Function function) {
  std::vector<double> values;
  for (const CloudPoint& point : points) values.push_back(function(point));
  return values;
}

/// As bytes, sorted: two clouds with the same points in any order are the same.
std::vector<std::string> sorted_bytes(const Cloud& points) {
  std::vector<std::string> bytes;
  for (const CloudPoint& point : points) {
    bytes.emplace_back(reinterpret_cast<const char*>(&point), sizeof point);
  }
  std::sort(bytes.begin(), bytes.end());
  return bytes;
}

template <typename Function>
TsdfVolume exact_volume(double size_m, int weight, Function signed_distance_m) {
  return testing::exact_volume(size_m, kResolution_m, weight, signed_distance_m);
}

TEST(SurfaceExtractor, FindsAnExactSphere) {
  constexpr double kRadius_m = 0.3;
  const Eigen::Vector3d center_W(0.013, -0.021, 0.037);
  TsdfVolume volume = exact_volume(
      1.0, 10, [&](const Eigen::Vector3d& p_W) { return (p_W - center_W).norm() - kRadius_m; });
  const Cloud points = extract(volume.snapshot());
  // Between two voxels the distance bends by 1/(8 R) = 0.4 % of a voxel; the mean of up to three
  // crossings half a voxel apart lies a chord's height, as much again, below the sphere.
  constexpr double kTolerance_vox = 0.01;
  // The normal turns by 1.9 degrees from voxel to voxel; half of that where the points that are
  // averaged lie on one side of this one.
  constexpr double kTolerance_deg = 1.0;
  for (const CloudPoint& p : points) {
    const Eigen::Vector3d from_center = position_W(p) - center_W;
    ASSERT_NEAR(from_center.norm(), kRadius_m, kTolerance_vox * kResolution_m);
    ASSERT_LT(angle_deg(normal_W(p), from_center), kTolerance_deg);
    ASSERT_NEAR(normal_W(p).norm(), 1.0, 1e-6);
    ASSERT_EQ(p.weight, 10.0F);
  }
  // A plane across the axes has fewer surface voxels than one along them, by 1/sqrt(3) at most.
  const double area_vox = 4 * M_PI * std::pow(kRadius_m / kResolution_m, 2);
  EXPECT_LT(static_cast<double>(points.size()), area_vox * 1.3);
  EXPECT_GT(static_cast<double>(points.size()), area_vox * 0.57);
}

TEST(SurfaceExtractor, GivesOnePointForEachColumnOfAPlaneBetweenBlocks) {
  // z = 0 is a face of blocks, half way between voxels: the crossing must not appear in both.
  TsdfVolume volume = exact_volume(0.64, 10, [](const Eigen::Vector3d& p_W) { return p_W.z(); });
  const Cloud points = extract(volume.snapshot());
  std::map<std::pair<int, int>, int> columns;
  for (const CloudPoint& p : points) {
    ASSERT_NEAR(p.z, 0.0, 1e-6);
    ASSERT_NEAR(p.nz, 1.0, 1e-6);
    ++columns[{std::lround(p.x / kResolution_m - 0.5), std::lround(p.y / kResolution_m - 0.5)}];
  }
  EXPECT_EQ(columns.size(), 64U * 64U);
  EXPECT_EQ(points.size(), columns.size());
}

TEST(SurfaceExtractor, IgnoresVoxelsSeenNoMoreOftenThanTheThreshold) {
  const auto plane = [](const Eigen::Vector3d& p_W) { return p_W.z() - 0.003; };
  EXPECT_TRUE(extract(exact_volume(0.64, 8, plane).snapshot(), 8).empty());
  EXPECT_EQ(extract(exact_volume(0.64, 9, plane).snapshot(), 8).size(), 64U * 64U);
}

TEST(SurfaceExtractor, FindsNothingInNothing) {
  EXPECT_TRUE(extract(DetachedBlocks{}).empty());
  TsdfVolume volume(volume_of(0.64));
  volume.allocate(make_block_coord(0, 0, 0));
  EXPECT_TRUE(extract(volume.snapshot()).empty());
}

TEST(SurfaceExtractor, FindsASphereSeenFromAllSides) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume(volume_of(1.6));
  fuse(testing::views_around(scene, 1.3, {-0.9, -0.3, 0.3, 0.9}, 12), volume);
  const Cloud points = extract(volume.snapshot(), 8);
  ASSERT_GT(points.size(), 20000U);
  const auto error_vox = map(points, [](const CloudPoint& p) {
    return std::abs(position_W(p).norm() - 0.5) / kResolution_m;
  });
  const auto error_deg =
      map(points, [](const CloudPoint& p) { return angle_deg(normal_W(p), position_W(p)); });
  // A pixel is 5 mm wide here and is taken for all voxels that it covers: at a slope of 45 degrees
  // up to 2.5 mm off, in each of some 15 views.
  EXPECT_LT(percentile(error_vox, 0.5), 0.1);
  EXPECT_LT(percentile(error_vox, 1.0), 0.5);
  // Projective distances grow towards the silhouette of each view, where it joins the mean.
  EXPECT_LT(percentile(error_deg, 0.5), 4.0);
  EXPECT_LT(percentile(error_deg, 1.0), 10.0);
}

TEST(SurfaceExtractor, FindsAPlaneSeenAlongAPath) {
  const auto scene = synthetic::make_scene_with_path("plane");
  const std::vector<View> views = testing::views_along_path(scene, 40);
  TsdfVolume volume(volume_of(4.0), views.front().X_WC.translation());
  fuse(views, volume);
  const Cloud points = extract(volume.snapshot(), 8);
  ASSERT_GT(points.size(), 20000U);
  const auto error_vox =
      map(points, [](const CloudPoint& p) { return std::abs(p.z) / kResolution_m; });
  const auto error_deg = map(
      points, [](const CloudPoint& p) { return angle_deg(normal_W(p), Eigen::Vector3d::UnitZ()); });
  EXPECT_LT(percentile(error_vox, 0.5), 0.05);
  EXPECT_LT(percentile(error_vox, 0.99), 0.15);
  EXPECT_LT(percentile(error_deg, 0.5), 0.5);
  EXPECT_LT(percentile(error_deg, 0.99), 3.0);
}

TEST(SurfaceExtractor, FindsTheSurfacesOfARoom) {
  const auto scene = synthetic::make_scene_with_path("box-room");
  const std::vector<View> views = testing::views_along_path(scene, 60);
  TsdfVolume volume(volume_of(4.8), {0.0, 0.0, 1.25});  // holds the whole room
  fuse(views, volume);
  const Cloud points = extract(volume.snapshot(), 8);
  ASSERT_GT(points.size(), 50000U);
  const auto error_vox = map(points, [&](const CloudPoint& p) {
    return std::abs(scene.scene.signed_distance(position_W(p))) / kResolution_m;
  });
  const auto error_deg = map(points, [&](const CloudPoint& p) {
    return angle_deg(normal_W(p), testing::gradient_of_distance(scene.scene, position_W(p)));
  });
  EXPECT_LT(percentile(error_vox, 0.5), 0.1);
  EXPECT_LT(percentile(error_vox, 0.95), 0.3);
  // Behind an edge that was never looked around, the hidden side is a guess of up to the truncation
  // distance where the step from one voxel to the next is not too great.
  EXPECT_LT(percentile(error_vox, 0.99), 0.6);
  EXPECT_LT(percentile(error_vox, 1.0), 4.5);
  EXPECT_LT(percentile(error_deg, 0.5), 1.0);
  // Edges are rounded by the averaging, over two voxels to either side.
  EXPECT_LT(percentile(error_deg, 0.9), 10.0);
}

/// The volume's surface in pieces: the camera leaves in small steps, nothing comes back.
Cloud extract_in_slices(TsdfVolume& volume, int num_steps, int* num_slices) {
  Cloud points;
  *num_slices = 0;
  const auto append = [&](const DetachedBlocks& blocks) {
    const Cloud part = extract(blocks);
    points.insert(points.end(), part.begin(), part.end());
    ++*num_slices;
  };
  Eigen::Vector3d camera_W = volume.center_W();
  for (int step = 0; step < num_steps; ++step) {
    const Eigen::Vector3d directions_W[] = {{0.17, 0.05, 0.0}, {0.0, 0.0, -0.25}, {0.3, 0.3, -0.1}};
    camera_W += directions_W[step % 3];
    for (const DetachedBlocks& slice : volume.shift_to(camera_W)) append(slice);
  }
  append(volume.detach_all());
  return points;
}

TEST(SurfaceExtractor, GivesTheSameSurfaceInSlicesAsInOnePiece) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume(volume_of(1.6));
  fuse(testing::views_around(scene, 1.3, {-0.9, 0.3}, 5), volume);
  const Cloud whole = extract(volume.snapshot());
  int num_slices = 0;
  const Cloud pieces = extract_in_slices(volume, 6, &num_slices);
  ASSERT_GT(num_slices, 6);
  ASSERT_GT(whole.size(), 20000U);
  EXPECT_EQ(pieces.size(), whole.size());
  EXPECT_TRUE(sorted_bytes(pieces) == sorted_bytes(whole));
}

TEST(SurfaceExtractor, GivesTheSameSurfaceWhenABallMovesOn) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume({.max_range_m = 0.8, .resolution_m = kResolution_m});
  fuse(testing::views_around(scene, 1.3, {-0.9, 0.3}, 5), volume);
  const Cloud whole = extract(volume.snapshot());
  int num_slices = 0;
  const Cloud pieces = extract_in_slices(volume, 15, &num_slices);
  ASSERT_GT(num_slices, 6);
  ASSERT_GT(whole.size(), 20000U);
  EXPECT_EQ(pieces.size(), whole.size());
  EXPECT_TRUE(sorted_bytes(pieces) == sorted_bytes(whole));
}

TEST(SurfaceExtractor, GivesTheSameSurfaceWhenABallIsTooFull) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume({.max_range_m = 0.8, .resolution_m = kResolution_m, .max_memory_mb = 2.0});
  fuse(testing::views_around(scene, 1.3, {-0.9, 0.3}, 5), volume);
  const Cloud whole = extract(volume.snapshot());
  Cloud pieces;
  const auto append = [&pieces](const DetachedBlocks& blocks) {
    const Cloud part = extract(blocks);
    pieces.insert(pieces.end(), part.begin(), part.end());
  };
  for (int lowest = -8; lowest <= 16; ++lowest) {  // a diagonal cut wanders through the sphere
    for (const DetachedBlocks& slice : volume.shift_to(Eigen::Vector3d::Zero())) append(slice);
    for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
      const BlockCoord& coord = volume.coord(slot);
      if (volume.in_use(slot) && coord.x + coord.y >= lowest) volume.mark_seen(slot);
    }
  }
  EXPECT_LT(pieces.size(), whole.size());
  EXPECT_GT(pieces.size(), whole.size() / 4);
  append(volume.detach_all());
  EXPECT_EQ(pieces.size(), whole.size());
  EXPECT_TRUE(sorted_bytes(pieces) == sorted_bytes(whole));
}

TEST(SurfaceExtractor, MapsTheSameSurfaceWhileTheVolumeMoves) {
  // The camera looks down and sees 0.4 m to either side, well inside the small cube: what leaves is
  // complete.
  constexpr double kHeight_m = 0.6;
  const auto scene = synthetic::make_scene("plane");
  TsdfVolume moving(volume_of(1.6), {-1.2, 0.0, kHeight_m});
  TsdfVolume standing(volume_of(4.0));
  const Integrator integrator({});
  Cloud pieces;
  const auto append = [&pieces](const DetachedBlocks& blocks) {
    const Cloud part = extract(blocks, 2);
    pieces.insert(pieces.end(), part.begin(), part.end());
  };
  for (int i = 0; i <= 60; ++i) {
    const Eigen::Vector3d camera_W(-1.2 + 0.04 * i, 0.0, kHeight_m);
    const View view = testing::make_view(
        scene, synthetic::look_at(camera_W, camera_W + Eigen::Vector3d(0.0, 0.02, -1.0)));
    for (const DetachedBlocks& slice : moving.shift_to(camera_W)) append(slice);
    integrator.integrate(view.frame, view.X_WC, moving);
    integrator.integrate(view.frame, view.X_WC, standing);
  }
  append(moving.detach_all());
  const Cloud whole = extract(standing.snapshot(), 2);
  ASSERT_GT(whole.size(), 10000U);
  EXPECT_EQ(pieces.size(), whole.size());
  EXPECT_TRUE(sorted_bytes(pieces) == sorted_bytes(whole));
}

TEST(SurfaceExtractor, MapsAPlaceAgainWhereTheVolumeComesBack) {
  // There and back along a plane: a second slice over the first, the same to the byte.
  const auto plane = [](const Eigen::Vector3d& p_W) { return p_W.z() - 0.003; };
  TsdfVolume volume = exact_volume(0.64, 10, plane);
  const auto leave = [&volume](double x_m) {
    Cloud points;
    for (const DetachedBlocks& slice : volume.shift_to({x_m, 0.0, 0.0})) {
      const Cloud part = extract(slice);
      points.insert(points.end(), part.begin(), part.end());
    }
    return points;
  };
  const Cloud first = leave(0.16);
  EXPECT_TRUE(leave(0.0).empty()) << "nothing was mapped on the other side";
  testing::allocate_around_surface(volume, plane);
  testing::set_exact_distances(volume, 10, plane);
  const Cloud second = leave(0.16);
  EXPECT_EQ(first.size(), 16U * 64U);
  EXPECT_TRUE(sorted_bytes(first) == sorted_bytes(second));
}

/// A plate 1 m before the camera, a wall 2 m before it; nothing between them.
View plate_before_a_wall() {
  View view;
  view.frame.intrinsics = testing::small_camera();
  view.frame.depth_m = cv::Mat_<float>(240, 320, 2.0F);
  view.frame.depth_m(cv::Rect(100, 80, 120, 80)).setTo(1.0F);
  return view;
}

TEST(SurfaceExtractor, BuildsNoWallsBehindOutlines) {
  const View view = plate_before_a_wall();
  TsdfVolume volume(volume_of(4.5));
  fuse({view, view}, volume);
  const auto num_between = [&](double max_step_vox) {
    const Cloud points = SurfaceExtractor({.weight_threshold = 0, .max_step_vox = max_step_vox})
                             .extract(volume.snapshot());
    EXPECT_GT(points.size(), 30000U);
    return std::count_if(points.begin(), points.end(), [](const CloudPoint& p) {
      return std::abs(p.z - 1.0F) > kResolution_m && std::abs(p.z - 2.0F) > kResolution_m;
    });
  };
  EXPECT_EQ(num_between(SurfaceExtractor::Config().max_step_vox), 0);
  EXPECT_GT(num_between(100.0), 300);
}

TEST(SurfaceExtractor, TakesTheColorThatWasSeen) {
  const auto scene = synthetic::make_scene("plane");
  View view = testing::make_view(scene, synthetic::look_at({0.0, -0.3, 0.8}, {0.0, 0.0, 0.0}));
  view.frame.color_rgb.setTo(cv::Scalar(200, 100, 7));
  TsdfVolume volume(volume_of(2.4));
  fuse({view, view, view}, volume);
  const Cloud points = extract(volume.snapshot());
  ASSERT_FALSE(points.empty());
  for (const CloudPoint& p : points) {
    ASSERT_EQ(p.red, 200);
    ASSERT_EQ(p.green, 100);
    ASSERT_EQ(p.blue, 7);
  }
}

TEST(SurfaceExtractor, RefusesAConfigurationThatCannotWork) {
  EXPECT_THAT([] { SurfaceExtractor extractor({.weight_threshold = -1}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("weight_threshold is -1")));
  EXPECT_THAT([] { SurfaceExtractor extractor({.normal_radius_vox = 2.1}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("normal_radius_vox is 2.1")));
}

}  // namespace
}  // namespace kintsugi::mapper
