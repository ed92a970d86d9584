#pragma once
// Recordings whose lists have the numbers of the frames where other recordings have times, as the
// TUM-compatible files of ICL-NUIM do: 1, 2, 3, ...

#include <cstdint>

#include "mapper/openni2_driver/formats/image_list.hpp"

namespace kintsugi::mapper {

/// Frames a second of such a recording: the nominal rate of ICL-NUIM and of every camera for which
/// the TUM layout was made.
inline constexpr int kNumberedFrames_Hz = 30;

/// Whether the times of all images, depth and colour, are frame numbers: whole numbers, written
/// without a decimal point, in steps that are small (the median step of the depth images is at most
/// 10).
///
/// Such a list cannot be one of seconds. Whole seconds in ascending order mean at most one image a
/// second, each exactly on a second: a hand-held camera at that rate cannot be followed, and no
/// camera keeps to exact seconds. A step of more than one is a recording of which every n-th frame
/// was kept; beyond 10 that is fewer than 3 frames a second. Larger steps are other units
/// (milliseconds between the frames of a camera of up to 90 Hz are 11 and more).
bool has_frame_numbers(const ImageLists& lists);

/// Microseconds at which a frame was taken.
std::int64_t time_of_frame(std::int64_t number);

/// Turns frame numbers into times at kNumberedFrames_Hz.
void replace_frame_numbers(ImageLists& lists);

}  // namespace kintsugi::mapper
