#include "mapper/openni2_driver/formats/numbered_images.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <string>
#include <system_error>

#include "mapper/openni2_driver/formats/frame_numbers.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxDigits = 15;  // far below the end of 64 bits, in microseconds too

std::optional<std::int64_t> number_in(std::string_view digits) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool is_number = !digits.empty() && digits.size() <= kMaxDigits && error == std::errc() &&
                         end == digits.data() + digits.size() && digits.front() != '-';
  return is_number ? std::optional(number) : std::nullopt;
}

/// @param name without prefix and suffix
std::optional<NumberedImage> image_of(std::string_view name, const fs::path& file) {
  const std::size_t dash = name.find('-');
  const auto number = number_in(name.substr(0, dash));
  if (!number) return std::nullopt;
  if (dash == std::string_view::npos) return NumberedImage{*number, std::nullopt, file};
  const auto utime = number_in(name.substr(dash + 1));
  return utime ? std::optional(NumberedImage{*number, utime, file}) : std::nullopt;
}

std::vector<NumberedImage> by_number(std::vector<NumberedImage> images) {
  std::ranges::sort(images, [](const NumberedImage& a, const NumberedImage& b) {
    return a.number != b.number ? a.number < b.number : a.file < b.file;
  });
  const auto same = std::ranges::adjacent_find(images, {}, &NumberedImage::number);
  if (same != images.end()) {
    throw std::runtime_error(same->file.string() + " and " + (same + 1)->file.string() +
                             " have the same number");
  }
  return images;
}

template <typename NumberPart>
std::vector<NumberedImage> images_in(const fs::path& folder, NumberPart number_part) {
  std::vector<NumberedImage> images;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    const std::optional<std::string_view> part = number_part(name);
    if (!part) continue;
    if (auto image = image_of(*part, entry.path())) images.push_back(*std::move(image));
  }
  return by_number(std::move(images));
}

std::optional<std::string_view> between(std::string_view name, std::string_view prefix,
                                        std::string_view suffix) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return std::nullopt;
  if (name.size() < prefix.size() + suffix.size()) return std::nullopt;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  return name;
}

}  // namespace

std::vector<NumberedImage> numbered_images(const fs::path& folder, std::string_view prefix,
                                           std::string_view suffix) {
  return images_in(folder, [&](std::string_view name) { return between(name, prefix, suffix); });
}

std::vector<NumberedImage> numbered_images(const fs::path& folder) {
  return images_in(folder, [](std::string_view name) -> std::optional<std::string_view> {
    for (const std::string_view suffix : {".png", ".jpg", ".jpeg"}) {
      if (const auto part = between(name, "", suffix)) return part;
    }
    return std::nullopt;
  });
}

bool have_times(const std::vector<NumberedImage>& images) {
  return std::ranges::all_of(images, [](const NumberedImage& i) { return i.utime.has_value(); }) &&
         std::ranges::adjacent_find(images, std::greater_equal(), &NumberedImage::utime) ==
             images.end();
}

std::vector<std::int64_t> times_of(const std::vector<NumberedImage>& images) {
  std::vector<std::int64_t> utimes;
  utimes.reserve(images.size());
  const bool named = have_times(images);
  for (const NumberedImage& image : images) {
    utimes.push_back(named ? *image.utime : time_of_frame(image.number));
  }
  return utimes;
}

std::vector<fs::path> files_of(const std::vector<NumberedImage>& images) {
  std::vector<fs::path> files;
  files.reserve(images.size());
  for (const NumberedImage& image : images) files.push_back(image.file);
  return files;
}

}  // namespace kintsugi::mapper
