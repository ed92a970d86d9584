#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kintsugi::mapper {

struct TimedImage {
  std::int64_t utime = 0;      ///< microseconds
  bool has_point = false;      ///< the time is written with a decimal point
  std::filesystem::path file;  ///< path with the folder
};

/// The images of a recording, each list ascending strictly in time.
struct ImageLists {
  std::vector<TimedImage> depth;  ///< not empty
  std::vector<TimedImage> color;  ///< may be empty
};

/// Reads depth.txt and, if present, rgb.txt (lines `seconds file`). In a folder without depth.txt
/// it reads associations.txt (lines `seconds file seconds file`, one of the two files under
/// depth/), in which adjacent lines may repeat an image.
///
/// The images themselves are not looked at: one that is missing is found when it is read.
/// @throws std::runtime_error naming file, line and what was expected, for a list that is missing,
///   empty or malformed, or times that do not ascend
ImageLists read_image_lists(const std::filesystem::path& folder);

}  // namespace kintsugi::mapper
