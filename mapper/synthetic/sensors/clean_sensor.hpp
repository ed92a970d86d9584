#pragma once
// A depth camera that makes no error.

#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// True depth, rounded to millimetres, within a range. This is what recordings of other renderers
/// are like, and what `noise=off` leaves of another sensor.
class CleanSensor : public SensorModel {
 public:
  struct Config {
    Intrinsics intrinsics = default_intrinsics();
    Range range{.min_m = 0.1, .max_m = 30.0};  ///< every surface of the built-in scenes
  };

  /// @throws std::invalid_argument naming the bound that the range violates
  explicit CleanSensor(const Config& config) : config_(config) { validate(config_.range); }

  Intrinsics intrinsics() const override { return config_.intrinsics; }
  Range range() const override { return config_.range; }

 private:
  cv::Mat_<double> measure(const RenderedFrame& frame,
                           std::int64_t /*frame_index*/) const override {
    return frame.depth_m;
  }

  Config config_;
};

}  // namespace kintsugi::synthetic
