#include "mapper/source/frames/device_mode.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace kintsugi::mapper {
namespace {

constexpr int kUsualRate_hz = 30;
constexpr int kMaxPixels = 16384;  // a side
constexpr int kMaxRate_hz = 1000;

/// The number at the front of `text`, which is taken off; 0 when there is none.
int take_number(std::string_view& text, int greatest) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || number < 1 || number > greatest) return 0;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take(std::string_view& text, char expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(1);
  return true;
}

/// How far a mode is from the wanted one; the smaller the better.
std::array<int, 2> distance(const DeviceMode& mode, const DeviceMode& wanted) {
  const int rate_hz = wanted.rate_hz == 0 ? kUsualRate_hz : wanted.rate_hz;
  return {std::abs(mode.width - wanted.width) + std::abs(mode.height - wanted.height),
          std::abs(mode.rate_hz - rate_hz)};
}

}  // namespace

DeviceMode DeviceMode::parse(const std::string& field, const std::string& text) {
  DeviceMode mode;
  std::string_view rest = text;
  mode.width = take_number(rest, kMaxPixels);
  bool valid = mode.width > 0 && take(rest, 'x');
  if (valid) mode.height = take_number(rest, kMaxPixels);
  valid = valid && mode.height > 0;
  if (valid && take(rest, '@')) {
    mode.rate_hz = take_number(rest, kMaxRate_hz);
    valid = mode.rate_hz > 0;
  }
  if (!valid || !rest.empty()) {
    throw std::invalid_argument(field + " is '" + text +
                                "', expected WIDTHxHEIGHT or WIDTHxHEIGHT@HZ, such as 640x480@30");
  }
  return mode;
}

std::string to_string(const DeviceMode& mode) {
  return std::to_string(mode.width) + "x" + std::to_string(mode.height) + "@" +
         std::to_string(mode.rate_hz);
}

std::string list_of(std::span<const DeviceMode> offered) {
  std::vector<DeviceMode> modes(offered.begin(), offered.end());
  std::ranges::sort(modes, [](const DeviceMode& a, const DeviceMode& b) {
    return std::tuple(a.width, a.height, a.rate_hz) > std::tuple(b.width, b.height, b.rate_hz);
  });
  modes.erase(std::unique(modes.begin(), modes.end()), modes.end());
  std::string list;
  for (const DeviceMode& mode : modes) {
    if (!list.empty()) list += ' ';
    list += to_string(mode);
  }
  return list.empty() ? "none" : list;
}

std::optional<std::size_t> nearest_mode(std::span<const DeviceMode> offered,
                                        const DeviceMode& wanted) {
  const auto best = std::ranges::min_element(
      offered, {}, [&](const DeviceMode& mode) { return distance(mode, wanted); });
  if (best == offered.end()) return std::nullopt;
  return static_cast<std::size_t>(best - offered.begin());
}

std::optional<std::size_t> find_mode(std::span<const DeviceMode> offered,
                                     const DeviceMode& wanted) {
  const auto index = nearest_mode(offered, wanted);
  if (!index || offered[*index].size() != wanted.size()) return std::nullopt;
  if (wanted.rate_hz != 0 && offered[*index].rate_hz != wanted.rate_hz) return std::nullopt;
  return index;
}

std::optional<cv::Rect> registered_part(cv::Size color, cv::Size depth) {
  // Rounded up: 320x240 depth of a colour image 641 wide needs 481 rows.
  const auto width = static_cast<std::int64_t>(color.width);
  const std::int64_t rows = (width * depth.height + depth.width - 1) / depth.width;
  if (rows > color.height) return std::nullopt;
  return cv::Rect(0, 0, color.width, static_cast<int>(rows));
}

}  // namespace kintsugi::mapper
