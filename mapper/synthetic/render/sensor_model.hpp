#pragma once
// Simulates the depth images of a structured-light camera.

#include <cstdint>

#include <opencv2/core.hpp>

#include "mapper/synthetic/render/renderer.hpp"

namespace kintsugi::synthetic {

/// Adds noise along the ray that grows with the square of depth, quantises the disparity, and
/// removes pixels at depth edges, at grazing angles and out of range. Without noise, depth is only
/// rounded to millimetres and limited in range. The random numbers of a pixel are a hash of (seed,
/// frame, pixel), so a frame does not depend on the order of frames or the number of threads.
class SensorModel {
 public:
  struct Config {
    bool noise = true;         ///< off: depth is rounded to millimetres, within range
    double min_depth_m = 0.4;  ///< nearer pixels are invalid, > 0
    double max_depth_m = 5.0;  ///< farther pixels are invalid, <= 65 (16 bits, millimetres)
    // sigma(z) = sigma_base_m + sigma_square_per_m * (z - sigma_offset_m)^2
    double sigma_base_m = 0.0012;        ///< >= 0
    double sigma_square_per_m = 0.0019;  ///< 1/m, >= 0
    double sigma_offset_m = 0.4;
    double baseline_m = 0.075;           ///< between projector and camera, > 0
    double disparity_step_px = 0.125;    ///< 0: disparity is not quantised
    double max_incidence_rad = 1.396;    ///< 80 degrees; invalid above, (0, pi / 2]
    double edge_step_ratio = 0.03;       ///< a neighbour nearer or farther by this share of z...
    double edge_loss_probability = 0.6;  ///< ...loses the pixel this often, [0, 1]
    std::uint32_t seed = 1;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit SensorModel(const Config& config);

  /// Standard deviation of the noise at depth z, metres.
  double sigma_m(double z_m) const;

  /// Depth in millimetres as the device delivers it; 0 is invalid.
  cv::Mat_<std::uint16_t> apply(const RenderedFrame& frame, std::int64_t frame_index) const;

 private:
  Config config_;
};

}  // namespace kintsugi::synthetic
