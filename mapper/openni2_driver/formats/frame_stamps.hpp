#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace kintsugi::mapper {

/// Times of frames from stamps of unknown unit.
///
/// The unit is the one of seconds, milliseconds, microseconds and nanoseconds in which the median
/// step is that of a camera: 2 ms to 2 s. As that is a factor of 1,000, it can be one unit only.
/// @return microseconds; nullopt when the stamps do not ascend strictly or are no camera's
std::optional<std::vector<std::int64_t>> times_of_stamps(const std::vector<std::uint64_t>& stamps);

/// Microseconds of frames without times, numbered from 0, at kNumberedFrames_Hz.
std::vector<std::int64_t> times_of_numbers(std::size_t num_frames);

}  // namespace kintsugi::mapper
