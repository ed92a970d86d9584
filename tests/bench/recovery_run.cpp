#include "tests/bench/recovery_run.hpp"

#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "lcmtypes/base/stopwatch.hpp"

namespace kintsugi::mapper::bench {
namespace {

constexpr double kCellSide_m = 0.06;
constexpr int kPixelStep = 8;

/// The places that were fused, in cells large enough for a reference with errors of centimetres.
class SeenSpace {
 public:
  void add(const RgbdFrame& frame, const Pose& X_WC) {
    for_each_point(frame, X_WC,
                   [this](const Eigen::Vector3d& p_W) { cells_.insert(cell_of(p_W)); });
  }

  /// Share of the valid pixels of the frame that are in cells seen before.
  double share_known(const RgbdFrame& frame, const Pose& X_WC) const {
    std::int64_t valid = 0;
    std::int64_t known = 0;
    for_each_point(frame, X_WC, [&](const Eigen::Vector3d& point_W) {
      ++valid;
      known += cells_.contains(cell_of(point_W)) ? 1 : 0;
    });
    return valid > 0 ? static_cast<double>(known) / static_cast<double>(valid) : 0.0;
  }

 private:
  template <typename Visit>
  static void for_each_point(const RgbdFrame& frame, const Pose& X_WC, const Visit& visit) {
    const Intrinsics& camera = frame.intrinsics;
    for (int v = 0; v < frame.depth_m.rows; v += kPixelStep) {
      for (int u = 0; u < frame.depth_m.cols; u += kPixelStep) {
        const double z = frame.depth_m(v, u);
        if (!std::isfinite(z)) continue;
        visit(X_WC *
              Eigen::Vector3d(z * (u - camera.cx) / camera.fx, z * (v - camera.cy) / camera.fy, z));
      }
    }
  }

  static std::int64_t cell_of(const Eigen::Vector3d& point_W) {
    constexpr std::int64_t kHalf = 1 << 20;
    std::int64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key =
          key << 21 | (static_cast<std::int64_t>(std::floor(point_W[axis] / kCellSide_m)) + kHalf);
    }
    return key;
  }

  std::unordered_set<std::int64_t> cells_;
};

/// Where the frames are in the end.
void correct(std::vector<FrameOutcome>& outcomes, const std::map<int, Trajectory>& paths) {
  std::map<std::int64_t, std::pair<int, Pose>> located;
  for (const auto& [part, path] : paths) {
    for (const StampedPose& pose : path) located[pose.utime] = {part, pose.X_WC};
  }
  for (FrameOutcome& outcome : outcomes) {
    if (!outcome.located) continue;
    std::tie(outcome.part, outcome.tracking.X_WC) = located.at(outcome.planned.utime);
  }
}

}  // namespace

std::vector<FrameOutcome> run_plan(const Recording& recording, const Plan& plan, bool with_color,
                                   const MapperPipeline::Config& config,
                                   const std::vector<std::optional<Pose>>& X_WC_reference) {
  MapperPipeline pipeline(config);
  SeenSpace seen;
  std::vector<FrameOutcome> outcomes;
  for (const PlannedFrame& planned : plan) {
    RgbdFrame frame = spoil(recording.frame(planned.frame), planned);
    if (!with_color) frame.color_rgb.release();
    FrameOutcome outcome;
    outcome.planned = planned;
    const auto& X_WC_true = X_WC_reference.at(planned.frame);
    if (X_WC_true) outcome.view_known = seen.share_known(frame, *X_WC_true);
    const Stopwatch stopwatch;
    outcome.tracking = pipeline.process(frame).tracking;
    outcome.frame_ms = stopwatch.elapsed_ms();
    outcome.located = is_located(outcome.tracking.state);
    if (outcome.located && X_WC_true) seen.add(frame, *X_WC_true);
    outcomes.push_back(std::move(outcome));
  }
  pipeline.finish();
  correct(outcomes, pipeline.corrected_paths());
  return outcomes;
}

std::vector<std::optional<Pose>> undisturbed_path(const Recording& recording, bool with_color,
                                                  const MapperPipeline::Config& config) {
  std::vector<std::optional<Pose>> X_WC(recording.num_frames());
  const Plan plan = plan_disturbance("none", recording.num_frames(), recording.period_us());
  for (const FrameOutcome& outcome : run_plan(recording, plan, with_color, config, X_WC)) {
    if (outcome.located) X_WC[outcome.planned.frame] = outcome.tracking.X_WC;
  }
  return X_WC;
}

}  // namespace kintsugi::mapper::bench
