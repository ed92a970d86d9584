#include "mapper/core/fusion/integrator.hpp"

#include <algorithm>
#include <cstdint>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/fusion/block_allocation.hpp"
#include "mapper/core/fusion/farthest_depths.hpp"
#include "mapper/core/fusion/truncation.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/volume/block_visibility.hpp"

namespace kintsugi::mapper {
namespace {

/// The image without padding between rows, as the kernels need it.
template <typename Image>
Image continuous(const Image& image) {
  return image.isContinuous() ? image : image.clone();
}

/// All but the images and their range of depths.
IntegrationFrame make_integration_frame(const PinholeCamera& camera, const Eigen::Matrix3f& R_WC,
                                        const TsdfVolume& volume, const DepthNoise& noise) {
  IntegrationFrame frame{.camera = camera};
  for (int axis_W = 0; axis_W < 3; ++axis_W) {
    for (int axis_C = 0; axis_C < 3; ++axis_C) {
      frame.step_C[axis_W][axis_C] = R_WC(axis_W, axis_C) * volume.resolution_m();
    }
  }
  const int max_weight = volume.config().max_weight;
  frame.truncation = truncation_by_depth(volume, noise);
  frame.max_weight = static_cast<float>(max_weight);
  frame.max_color_weight = static_cast<float>(std::min(max_weight, 255));
  return frame;
}

IntegrationBlock make_integration_block(const VisibleBlock& block, const Eigen::Matrix3f& R_WC,
                                        TsdfVolume& volume) {
  constexpr float kHalfBlock_vox = 0.5F * (kBlockSide - 1);
  const Eigen::Vector3f to_center_W =
      Eigen::Vector3f::Constant(kHalfBlock_vox * volume.resolution_m());
  const Eigen::Vector3f origin_C = block.center_C - R_WC.transpose() * to_center_W;
  return {.voxels = volume.voxels(block.slot).voxels.data(),
          .colors = volume.colors(block.slot).colors.data(),
          .origin_C = {origin_C.x(), origin_C.y(), origin_C.z()}};
}

/// Whether a block was observed often enough, and each of its observed voxels is at least the
/// smallest truncation distance before a surface. Noisy depth allocates many such blocks: they tell
/// no more than that nothing is there, as blocks that do not exist do.
bool is_free_space(const VoxelBlock& block, int least_distance_raw) {
  constexpr int kEnough = 8;  // observations
  bool is_near_surface = false;
  int most_observations = 0;
  for (const Voxel voxel : block.voxels) {  // no branches, so that the compiler can vectorise it
    const bool is_observed = voxel_weight(voxel) > 0;
    is_near_surface |= is_observed & (voxel_distance_raw(voxel) < least_distance_raw);
    most_observations = std::max(most_observations, voxel_weight(voxel));
  }
  return !is_near_surface && most_observations >= kEnough;
}

/// Whether it is a block's turn to be looked at: once in 16 frames.
bool is_due(const BlockCoord& coord, std::uint32_t frame) {
  const auto sum = static_cast<std::uint32_t>(coord.x + coord.y + coord.z);
  return (sum + frame) % 16 == 0;
}

}  // namespace

void Integrator::Config::validate() const {
  check_range("min_depth_m", min_depth_m, 0.01, 100.0);
  check_range("max_depth_m", max_depth_m, min_depth_m, 100.0);
  if (instruction_set) kernels_for(*instruction_set);
}

Integrator::Integrator(const Config& config) : config_(config) {
  config_.validate();
  instruction_set_ = config_.instruction_set ? *config_.instruction_set : best_instruction_set();
}

void Integrator::integrate(const RgbdFrame& frame, const Pose& X_WC, TsdfVolume& volume,
                           const DepthNoise& noise) const {
  check_camera(frame.intrinsics, X_WC);
  check_image_size("depth_m", frame.depth_m.size(), frame.intrinsics);
  const bool has_color = !frame.color_rgb.empty();
  if (has_color) check_image_size("color_rgb", frame.color_rgb.size(), frame.intrinsics);

  const auto min_depth_m = static_cast<float>(config_.min_depth_m);
  const auto max_depth_m = static_cast<float>(config_.max_depth_m);
  const Kernels& kernels = kernels_for(instruction_set_);
  const cv::Mat_<float> depth_m = continuous(frame.depth_m);
  const PinholeCamera camera = pinhole_camera(frame.intrinsics);
  allocate_seen_blocks(depth_m, camera, X_WC, min_depth_m, max_depth_m, kernels, volume);
  const Eigen::Matrix3f R_WC = X_WC.linear().cast<float>();
  const std::vector<VisibleBlock> visible =
      find_visible_blocks(volume, camera, X_WC, max_depth_m + volume.max_truncation_m());

  cv::Mat_<cv::Vec4b> color_rgbx;
  if (has_color) cv::cvtColor(frame.color_rgb, color_rgbx, cv::COLOR_RGB2RGBA);
  IntegrationFrame integration_frame = make_integration_frame(camera, R_WC, volume, noise);
  integration_frame.min_depth_m = min_depth_m;
  integration_frame.max_depth_m = max_depth_m;
  integration_frame.depth_m = depth_m[0];
  if (has_color) integration_frame.color_rgbx = color_rgbx.ptr<std::uint32_t>();

  const bool keeps_free_space = volume.config().region == RegionShape::kCube;
  const int least_distance_raw =
      static_cast<int>(kDistanceScale * volume.truncation_m() / volume.max_truncation_m());
  const FarthestDepths farthest(depth_m, camera, max_depth_m);
  const float radius_m = block_radius_m(volume);
  const TruncationByDepth truncation = integration_frame.truncation;
  enum class Outcome : std::uint8_t { kHidden, kFused, kFreeSpace };
  std::vector<Outcome> outcomes(visible.size(), Outcome::kHidden);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, visible.size(), 32), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto& [slot, center_C] = visible[i];
      const float farthest_m = farthest.within(center_C, radius_m);
      if (center_C.z() - radius_m > farthest_m + truncation_at(farthest_m, truncation)) continue;
      kernels.integrate_block(integration_frame, make_integration_block(visible[i], R_WC, volume));
      outcomes[i] = Outcome::kFused;
      if (keeps_free_space || !is_due(volume.coord(slot), volume.num_moves())) continue;
      if (is_free_space(volume.voxels(slot), least_distance_raw)) outcomes[i] = Outcome::kFreeSpace;
    }
  });
  for (std::size_t i = 0; i < visible.size(); ++i) {
    if (outcomes[i] == Outcome::kFused) volume.mark_seen(visible[i].slot);
    if (outcomes[i] == Outcome::kFreeSpace) volume.discard(visible[i].slot);
  }
}

}  // namespace kintsugi::mapper
