#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kintsugi::mapper {

struct TimedImage {
  std::int64_t utime = 0;      ///< microseconds
  std::filesystem::path file;  ///< with the folder
};

/// The images of a recording, each list ascending strictly in time.
struct ImageLists {
  std::vector<TimedImage> depth;  ///< not empty
  std::vector<TimedImage> color;  ///< may be empty
};

/// Reads depth.txt and, where there is one, rgb.txt (lines `seconds file`); in a folder without
/// depth.txt, associations.txt (lines `seconds file seconds file`, one of the two files under
/// depth/), where neighbouring lines may repeat an image.
/// @throws std::runtime_error naming file, line and what was expected: no list, an empty one, a
/// line that does not parse, times that do not ascend, an image that is not there.
ImageLists read_image_lists(const std::filesystem::path& folder);

}  // namespace kintsugi::mapper
