#pragma once

namespace kintsugi::mapper {

/// The state that a device reports.
enum class DeviceState {
  kPlaying,
  kEnded,   ///< the end of a recording
  kFailed,  ///< the device reports a fault
  kGone,    ///< the device has been disconnected
};

}  // namespace kintsugi::mapper
