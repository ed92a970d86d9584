// The vector raycaster against one ray at a time, and its instruction sets against each other.

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/frame/camera.hpp"
#include "mapper/core/fusion/ray_tiles.hpp"
#include "mapper/core/fusion/raycaster.hpp"
#include "tests/mapper/core/scene_fusion.hpp"
#include "tests/mapper/core/simd/ray_marcher.hpp"
#include "tests/mapper/core/simd/tsdf_sampler.hpp"

namespace kintsugi::mapper {
namespace {

using testing::camera_of;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kResolution_m = 0.01;
constexpr Raycaster::Config kFromNearby = {.min_depth_m = 0.02};

/// A volume and a camera; the scenarios cover the different ways in which rays end.
struct Scenario {
  std::string name;
  const TsdfVolume* volume = nullptr;
  Pose X_WC = Pose::Identity();
  Intrinsics camera;
  cv::Mat_<float> guide_m;
};

std::optional<float> cast_slowly(testing::RayMarcher& marcher, const RaycastTile& tile,
                                 float start_m) {
  if (start_m > tile.near_m && start_m < tile.far_m) {
    if (const auto depth_m = marcher.find_surface(start_m, tile.far_m)) return depth_m;
  }
  return marcher.find_surface(tile.near_m, tile.far_m);
}

cv::Mat_<float> raycast_slowly(const Scenario& scenario) {
  const TsdfVolume& volume = *scenario.volume;
  const PinholeCamera camera = pinhole_camera(scenario.camera);
  const cv::Mat_<float>& guide_m = scenario.guide_m;
  const double resolution_m = volume.config().resolution_m;
  const BlockCoord& min = volume.min_block();
  const Eigen::Vector3d corner_vox = Eigen::Vector3d(min.x, min.y, min.z) * kBlockSide;
  const Eigen::Vector3f origin_vox =
      (scenario.X_WC.translation() / resolution_m - corner_vox).cast<float>();
  const Eigen::Matrix3f vox_per_m = (scenario.X_WC.linear() / resolution_m).cast<float>();

  testing::TsdfSampler sampler(volume);
  cv::Mat_<float> depth_m(camera.height, camera.width, kNan);
  for (const RaycastTile& tile : find_ray_tiles(volume, camera, scenario.X_WC, 0.02F, 6.0F)) {
    for (int v = tile.v; v < std::min(tile.v + RaycastTile::kSide_px, camera.height); ++v) {
      for (int u = tile.u; u < std::min(tile.u + RaycastTile::kSide_px, camera.width); ++u) {
        const Eigen::Vector3f ray_C((static_cast<float>(u) - camera.cx) / camera.fx,
                                    (static_cast<float>(v) - camera.cy) / camera.fy, 1.0F);
        const testing::Ray ray{.origin_vox = origin_vox, .direction_vox_per_m = vox_per_m * ray_C};
        testing::RayMarcher marcher(volume, ray, sampler);
        const float guide = guide_m.empty()
                                ? 0.0F
                                : guide_m((2 * v + 1) * guide_m.rows / 2 / camera.height,
                                          (2 * u + 1) * guide_m.cols / 2 / camera.width);
        const auto depth = cast_slowly(marcher, tile, guide - 2.0F * volume.truncation_m());
        if (depth) depth_m(v, u) = *depth;
      }
    }
  }
  return depth_m;
}

/// A room with furniture, from its path and from places where rays are hard to follow.
class RaycastKernels : public ::testing::TestWithParam<InstructionSet> {
 protected:
  static void SetUpTestSuite() {
    const auto room = synthetic::make_scene_with_path("box-room");
    volume_ = new TsdfVolume(
        {.region = RegionShape::kCube, .volume_size_m = 4.8, .resolution_m = kResolution_m},
        {0.0, 0.0, 1.25});
    fuse(testing::views_along_path(room, 30), *volume_);
    empty_ = new TsdfVolume(
        {.region = RegionShape::kCube, .volume_size_m = 1.6, .resolution_m = kResolution_m});
    scenarios_ = new std::vector<Scenario>(scenarios(room));
  }
  static void TearDownTestSuite() {
    delete scenarios_;
    delete empty_;
    delete volume_;
  }
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << "not on this processor";
  }
  static cv::Mat_<float> raycast(const Scenario& scenario, InstructionSet instruction_set) {
    Raycaster::Config config = kFromNearby;
    config.instruction_set = instruction_set;
    return Raycaster(config)
        .raycast(*scenario.volume, scenario.X_WC, scenario.camera, scenario.guide_m)
        .depth_m;
  }

  static TsdfVolume* volume_;
  static TsdfVolume* empty_;
  static std::vector<Scenario>* scenarios_;

 private:
  static std::vector<Scenario> scenarios(const synthetic::SceneWithPath& room) {
    const Pose X_WC = room.trajectory.X_WC(0.37 * room.trajectory.duration_s());
    const cv::Mat_<float> depth_m =
        synthetic::render(room.scene, camera_of(640, 480), X_WC).depth_m;
    cv::Mat_<float> torn_m = depth_m.clone();  // guides that are missing, too near and too far
    torn_m.rowRange(0, 160).setTo(kNan);
    torn_m.colRange(0, 100).setTo(0.3F);
    torn_m.colRange(500, 640).setTo(5.5F);
    const Eigen::Vector3d on_wall_W = X_WC * Eigen::Vector3d(0.0, 0.0, depth_m(240, 320));
    const Eigen::Vector3d back_W = (X_WC.translation() - on_wall_W).normalized();
    const Eigen::Vector3d along_W = back_W.cross(Eigen::Vector3d(0.1, 0.2, 1.0)).normalized();
    const Eigen::Vector3d near_wall_W = on_wall_W + 0.03 * back_W;
    Pose outside = X_WC;
    outside.translation() += Eigen::Vector3d(6.0, 1.0, 0.5);
    return {
        {"a view without a guide", volume_, X_WC, camera_of(160, 120), {}},
        {"a view with a guide", volume_, X_WC, camera_of(320, 240), depth_m},
        {"a torn guide", volume_, X_WC, camera_of(320, 240), torn_m},
        {"no multiple of 16 or 4", volume_, X_WC, camera_of(161, 119), depth_m},
        {"a few pixels", volume_, X_WC, camera_of(2, 3), {}},
        {"in a block, along the wall",
         volume_,
         synthetic::look_at(near_wall_W, near_wall_W + along_W),
         camera_of(160, 120),
         {}},
        {"in a block, out of the wall",
         volume_,
         synthetic::look_at(on_wall_W - 0.01 * back_W, near_wall_W),
         camera_of(160, 120),
         {}},
        {"from outside, towards the cube",
         volume_,
         synthetic::look_at({3.2, 2.9, 3.0}, {0.0, 0.0, 1.25}),
         camera_of(160, 120),
         {}},
        {"from far outside", volume_, outside, camera_of(160, 120), {}},
        {"along an axis",
         volume_,
         synthetic::look_at({0.0, 0.0, 1.25}, {1.0, 0.0, 1.25}),
         camera_of(33, 33),
         {}},
        {"an empty volume", empty_, Pose::Identity(), camera_of(40, 30), {}},
    };
  }
};
TsdfVolume* RaycastKernels::volume_ = nullptr;
TsdfVolume* RaycastKernels::empty_ = nullptr;
std::vector<Scenario>* RaycastKernels::scenarios_ = nullptr;

TEST_P(RaycastKernels, SeeWhatARayAtATimeSees) {
  // Both do the same in single precision, but for the last bits of a pixel's direction: a ray at a
  // voxel's border may read its neighbour, and its crossing then be found from another bracket.
  constexpr double kSameDepth_m = 0.02 * kResolution_m;
  constexpr double kOtherShare = 0.002;
  std::int64_t num_seen = 0;
  for (const Scenario& scenario : *scenarios_) {
    const cv::Mat_<float> actual_m = raycast(scenario, GetParam());
    const cv::Mat_<float> expected_m = raycast_slowly(scenario);
    ASSERT_EQ(actual_m.size(), expected_m.size()) << scenario.name;
    double num_others = 0;
    for (int v = 0; v < actual_m.rows; ++v) {
      for (int u = 0; u < actual_m.cols; ++u) {
        const float a = actual_m(v, u);
        const float b = expected_m(v, u);
        const bool same = (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= kSameDepth_m;
        num_others += same ? 0 : 1;
        num_seen += std::isnan(b) ? 0 : 1;
      }
    }
    EXPECT_LE(num_others, kOtherShare * static_cast<double>(actual_m.total())) << scenario.name;
  }
  EXPECT_GT(num_seen, 200'000) << "the comparison compared nothing";
}

TEST_P(RaycastKernels, WriteTheBytesOfThePortableOne) {
  for (const Scenario& scenario : *scenarios_) {
    const cv::Mat_<float> expected_m = raycast(scenario, InstructionSet::kPortable);
    const cv::Mat_<float> actual_m = raycast(scenario, GetParam());
    EXPECT_EQ(std::memcmp(actual_m.data, expected_m.data, 4 * actual_m.total()), 0)
        << scenario.name;
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, RaycastKernels, ::testing::ValuesIn(kInstructionSets),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace kintsugi::mapper
