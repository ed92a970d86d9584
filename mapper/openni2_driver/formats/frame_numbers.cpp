#include "mapper/openni2_driver/formats/frame_numbers.hpp"

#include <algorithm>
#include <vector>

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kMaxMedianStep = 10;

bool all_whole(const std::vector<TimedImage>& images) {
  return std::ranges::all_of(images, [](const TimedImage& image) {
    return !image.has_point && image.utime % kSecond_us == 0;
  });
}

/// @param images at least 2, at whole seconds
std::int64_t median_step(const std::vector<TimedImage>& images) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < images.size(); ++i) {
    steps.push_back((images[i].utime - images[i - 1].utime) / kSecond_us);
  }
  const auto median = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), median, steps.end());
  return *median;
}

void number_to_time(std::vector<TimedImage>& images) {
  for (TimedImage& image : images) {
    image.utime = time_of_frame(image.utime / kSecond_us);
  }
}

}  // namespace

bool has_frame_numbers(const ImageLists& lists) {
  return lists.depth.size() > 1 && all_whole(lists.depth) && all_whole(lists.color) &&
         median_step(lists.depth) <= kMaxMedianStep;
}

std::int64_t time_of_frame(std::int64_t number) {
  return (number * kSecond_us + kNumberedFrames_Hz / 2) / kNumberedFrames_Hz;
}

void replace_frame_numbers(ImageLists& lists) {
  number_to_time(lists.depth);
  number_to_time(lists.color);
}

}  // namespace kintsugi::mapper
