#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// The id of the segment visible in each pixel; kNoSegment: none.
using IdImage = cv::Mat_<std::int32_t>;

}  // namespace kintsugi::viewer
