#pragma once
// A continuous-wave time-of-flight camera: Kinect v2.

#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// Noise along the ray that grows slowly with depth and steeply at grazing angles, and is
/// independent in every pixel (Fankhauser et al.: Kinect v2 for mobile robot navigation, ICAR
/// 2015):
///   sigma(z, angle) = 1.5 - 0.5 z + 0.3 z^2 + 0.1 z^(3/2) angle^2 / (pi / 2 - angle)^2   [mm],
/// z in metres, the angle between the ray and the surface's normal in radians.
///
/// A pixel that receives light from two surfaces measures a depth between them, a "flying pixel"
/// (Sarbolandi et al.: Kinect range sensing, CVIU 2015; Wasenmueller, Stricker: Comparison of
/// Kinect v1 and v2 depth images, ACCV workshops 2016).
class TimeOfFlight : public SensorModel {
 public:
  struct Config {
    Range range{.min_m = 0.5, .max_m = 4.5};  ///< as Microsoft specifies it
    double max_incidence_rad = 1.396;         ///< 80 degrees; too little light above, (0, pi / 2)
    double edge_step_ratio = 0.03;  ///< a neighbour nearer or farther by this share of z...
    /// ...mixes its light into the pixel this often, [0, 1]. An edge crosses one of the two pixels
    /// beside it.
    double flying_probability = 0.5;
    std::uint32_t seed = 1;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument as Config::validate()
  explicit TimeOfFlight(const Config& config);

  /// 512 x 424, f = 365 (the device's own calibration differs from one to the next by a pixel).
  Intrinsics intrinsics() const override { return centred_camera(512, 424, 365.0); }
  Range range() const override { return config_.range; }

  /// Standard deviation of the noise at depth z and incidence below pi / 2, metres.
  static double sigma_m(double z_m, double incidence_rad);

 private:
  cv::Mat_<double> measure(const RenderedFrame& frame, std::int64_t frame_index) const override;

  Config config_;
};

}  // namespace kintsugi::synthetic
