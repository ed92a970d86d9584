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
#include "mapper/core/fusion/free_space.hpp"
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

/// Fuses the frame into the blocks that it can reach.
void fuse(const IntegrationFrame& frame, const std::vector<VisibleBlock>& visible,
          const FarthestDepths& farthest, const Eigen::Matrix3f& R_WC, const Kernels& kernels,
          TsdfVolume& volume) {
  enum class Outcome : std::uint8_t { kHidden, kFused, kFreeSpace };
  std::vector<Outcome> outcomes(visible.size(), Outcome::kHidden);
  const float radius_m = block_radius_m(volume);
  const FreeSpace free_space(volume);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, visible.size(), 32), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const BlockSlot slot = visible[i].slot;
      const Eigen::Vector3f& center_C = visible[i].center_C;
      const float farthest_m = farthest.within(center_C, radius_m);
      const float reach_m = farthest_m + truncation_at(farthest_m, frame.truncation);
      if (center_C.z() - radius_m > reach_m) continue;
      kernels.integrate_block(frame, make_integration_block(visible[i], R_WC, volume));
      const bool is_empty =
          free_space.is_due(volume.coord(slot)) && free_space.is_all_of(volume.voxels(slot));
      outcomes[i] = is_empty ? Outcome::kFreeSpace : Outcome::kFused;
    }
  });
  for (std::size_t i = 0; i < visible.size(); ++i) {
    if (outcomes[i] == Outcome::kFused) volume.mark_seen(visible[i].slot);
    if (outcomes[i] == Outcome::kFreeSpace) volume.discard(visible[i].slot);
  }
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

  fuse(integration_frame, visible, FarthestDepths(depth_m, camera, max_depth_m), R_WC, kernels,
       volume);
}

}  // namespace kintsugi::mapper
