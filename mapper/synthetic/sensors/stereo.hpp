#pragma once
// An active stereo camera: RealSense D435.

#include "mapper/synthetic/sensors/noise_fields.hpp"
#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// Depth z = f B / disparity of the left image, matched in windows. The error of the disparity is
/// the same at every depth (0.08 px where the target has texture: Grunnet-Jepsen, Sweetser,
/// Woodfill: Tuning RealSense D4xx depth cameras for best performance, Intel), so
///   sigma(z) = z^2 0.08 / (f B),
/// 8 mm at 1.75 m and 42 mm at 4 m, and common to the pixels of a window. Lost are
///   - what the right image does not show: a shadow on the left of whatever is nearer, and a band
///     at the left border (Intel: "invalid depth band", RealSense D400 data sheet);
///   - windows that reach across a depth edge, most of them;
///   - surfaces without texture: patches that stay where they are in the scene, ragged at their
///     borders from frame to frame.
/// Together 33 to 45 % of the pixels in the built-in rooms.
class Stereo : public SensorModel {
 public:
  struct Config {
    Range range{.min_m = 0.2, .max_m = 10.0};  ///< of the data sheet, at this size
    double baseline_m = 0.050;                 ///< data sheet, > 0
    double sigma_disparity_px = 0.08;          ///< >= 0
    double disparity_step_px = 1.0 / 32;       ///< Intel: subpixel linearity; 0: not quantised
    int window_px = 7;                         ///< of matching, odd, >= 1
    double edge_step_ratio = 0.03;       ///< a neighbour nearer or farther by this share of z...
    double edge_loss_probability = 0.7;  ///< ...loses a window that contains it this often, [0, 1]
    double untextured_share = 0.30;      ///< of the surface, [0, 1]
    double untextured_size_m = 0.25;     ///< of a patch, > 0
    std::uint32_t seed = 1;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument as Config::validate()
  explicit Stereo(const Config& config);

  /// 640 x 480, f = 615: depth aligned to colour, as most recordings have it.
  Intrinsics intrinsics() const override { return centred_camera(640, 480, 615.0); }
  Range range() const override { return config_.range; }

 private:
  cv::Mat_<double> measure(const RenderedFrame& frame, std::int64_t frame_index) const override;
  double quantised(double disparity_px) const;

  Config config_;
  Patches untextured_;
};

}  // namespace kintsugi::synthetic
