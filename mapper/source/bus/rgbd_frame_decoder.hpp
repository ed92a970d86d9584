#pragma once

#include <memory>
#include <optional>

#include "lcmtypes/messages.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper {

/// Frames out of RGBD_FRAME messages: decompressed, undistorted, in metres.
class RgbdFrameDecoder {
 public:
  /// @param calibration replaces the intrinsics of the messages
  RgbdFrameDecoder(double max_range_m, std::optional<Intrinsics> calibration);
  ~RgbdFrameDecoder();
  RgbdFrameDecoder(const RgbdFrameDecoder&) = delete;
  RgbdFrameDecoder& operator=(const RgbdFrameDecoder&) = delete;

  /// @throws std::runtime_error when an image does not decode or has another size
  RgbdFrame decode(const RgbdFrameMessage& message);

 private:
  struct Conversion;

  const double max_range_m_;
  const std::optional<Intrinsics> calibration_;
  std::unique_ptr<Conversion> conversion_;  ///< of the last message, kept while it fits
};

}  // namespace kintsugi::mapper
