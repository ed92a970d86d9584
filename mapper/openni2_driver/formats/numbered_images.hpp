#pragma once
// Images whose names are numbers.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace kintsugi::mapper {

struct NumberedImage {
  std::int64_t number = 0;
  std::optional<std::int64_t> utime;  ///< from a name NUMBER-MICROSECONDS
  std::filesystem::path file;
};

/// Files PREFIX NUMBER SUFFIX, or PREFIX NUMBER-MICROSECONDS SUFFIX, by ascending number. Others
/// are left out. Empty when there is no such folder.
/// @throws std::runtime_error naming two files of the same number
std::vector<NumberedImage> numbered_images(const std::filesystem::path& folder,
                                           std::string_view prefix, std::string_view suffix);

/// The same with any suffix that images have: .png .jpg .jpeg.
std::vector<NumberedImage> numbered_images(const std::filesystem::path& folder);

/// Microseconds: those of the names, if all have them and they ascend; else the numbers at
/// kNumberedFrames_Hz.
std::vector<std::int64_t> times_of(const std::vector<NumberedImage>& images);
bool have_times(const std::vector<NumberedImage>& images);

std::vector<std::filesystem::path> files_of(const std::vector<NumberedImage>& images);

}  // namespace kintsugi::mapper
