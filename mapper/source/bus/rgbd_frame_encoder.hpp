#pragma once

#include "lcmtypes/messages.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper {

/// The message from which LcmSource makes the frame again.
///
/// Depth becomes a 16-bit PNG: in 0.1 mm units when everything is within 6.5534 m, so that depth
/// from a device in either of OpenNI2's units comes back as it was, else in 0.2 mm units (beyond
/// 13.1 m it is invalid). Colour becomes a JPEG of `jpeg_quality` (1..100), or with 0 a PNG without
/// loss. The images must fit frame.intrinsics.
RgbdFrameMessage encode_rgbd_frame(const RgbdFrame& frame, std::int64_t session, int jpeg_quality);

}  // namespace kintsugi::mapper
