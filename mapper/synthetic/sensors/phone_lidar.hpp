#pragma once
// The depth images of a phone with a LiDAR: iPhone and iPad Pro.

#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// A few hundred measured points (576: Luetzenburg, Kroon, Bjork: Evaluation of the Apple iPhone 12
/// Pro LiDAR, Scientific Reports 11, 2021), so 24 x 24 and about 10 pixels apart, from which the
/// device interpolates 256 x 192 pixels with the help of colour. Depth is smooth, and wrong
///   - at depth edges: they become ramps some pixels wide. Inverse depth is averaged, which leaves
///     planes as they are;
///   - elsewhere by about 1 % (the same source: 1 cm on objects at 1 m), alike over the distance of
///     the measured points. A part of the error belongs to the pixel and stays, the rest changes
///     within half a second.
/// Apple's own rate is 60 images a second; here it is that of the sequence.
class PhoneLidar : public SensorModel {
 public:
  struct Config {
    Range range{.min_m = 0.2, .max_m = 5.0};  ///< Apple: "up to 5 meters away"
    double relative_sigma = 0.01;             ///< of depth, >= 0
    double constant_share = 0.5;              ///< of the error's variance, stays; [0, 1]
    double cell_px = 12.0;                    ///< between independent errors, > 0
    int change_frames = 15;  ///< between independent errors of a pixel, >= 1; 0.5 s at 30 Hz
    int blur_px = 5;         ///< inverse depth is averaged twice over this width, odd, >= 1
    std::uint32_t seed = 1;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument as Config::validate()
  explicit PhoneLidar(const Config& config);

  /// 256 x 192, f = 212.
  Intrinsics intrinsics() const override { return centred_camera(256, 192, 212.0); }
  Range range() const override { return config_.range; }

 private:
  cv::Mat_<double> measure(const RenderedFrame& frame, std::int64_t frame_index) const override;

  Config config_;
};

}  // namespace kintsugi::synthetic
