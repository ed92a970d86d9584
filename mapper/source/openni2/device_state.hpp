#pragma once

namespace kintsugi::mapper {

/// What a device has said of itself.
enum class DeviceState {
  kPlaying,
  kEnded,   ///< a recording is over
  kFailed,  ///< the device reports a fault
  kGone,    ///< the device has been disconnected
};

}  // namespace kintsugi::mapper
