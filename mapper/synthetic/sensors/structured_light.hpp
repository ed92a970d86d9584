#pragma once
// A structured-light camera: Kinect v1, Xtion, Carmine.

#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// Noise along the ray that grows with the square of depth (Nguyen, Izadi, Lovell: Modeling Kinect
/// sensor noise for improved 3D reconstruction and tracking, 3DIMPVT 2012) and is independent in
/// every pixel; the disparity is quantised. Pixels at depth edges and at grazing angles are lost.
class StructuredLight : public SensorModel {
 public:
  struct Config {
    Range range{.min_m = 0.4, .max_m = 5.0};
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

  /// @throws std::invalid_argument as Config::validate()
  explicit StructuredLight(const Config& config);

  Intrinsics intrinsics() const override { return default_intrinsics(); }
  Range range() const override { return config_.range; }

  /// Standard deviation of the noise at depth z, metres.
  double sigma_m(double z_m) const;

 private:
  cv::Mat_<double> measure(const RenderedFrame& frame, std::int64_t frame_index) const override;

  Config config_;
};

}  // namespace kintsugi::synthetic
