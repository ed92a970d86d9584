#include "mapper/openni2_driver/recording/camera_imitation.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "mapper/openni2_driver/formats/text_file.hpp"

namespace kintsugi::mapper {
namespace {

using Imitation = CameraImitation;

constexpr double kMaxMilliseconds = 1e9;
constexpr int kMaxSide_px = 4096;
constexpr int kMaxRate_hz = 1000;

/// A value that is not as it should be; becomes a std::invalid_argument that names its option.
struct BadValue {};

struct Option {
  std::string_view name;
  std::string_view values;  ///< what it may be, for people
  std::function<void(Imitation&, const std::string&)> read;
};

template <typename Value>
using Words = std::vector<std::pair<std::string_view, Value>>;

template <typename Value>
Value one_of(const Words<Value>& words, std::string_view text) {
  const auto found = std::ranges::find(
      words, text, [](const auto& word) -> std::string_view { return word.first; });
  if (found == words.end()) throw BadValue();
  return found->second;
}

bool on_or_off(const std::string& text) {
  return one_of<bool>({{"on", true}, {"off", false}}, text);
}

int whole_number(std::string_view text, int least, int greatest) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) throw BadValue();
  if (number < least || number > greatest) throw BadValue();
  return number;
}

int count(const std::string& text) {
  return whole_number(text, 1, std::numeric_limits<int>::max());
}

double number(std::string_view text, double least, double greatest) {
  const auto value = parse_number(text);
  if (!value || *value < least || *value > greatest) throw BadValue();
  return *value;
}

std::int64_t milliseconds(const std::string& text, double least) {
  return static_cast<std::int64_t>(1000.0 * number(text, least, kMaxMilliseconds));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<Imitation::Mode> modes(const std::string& text) {
  std::vector<Imitation::Mode> list;
  for (const std::string_view mode : split(text, ',')) {
    const auto x = mode.find('x');
    const auto at = mode.find('@');
    if (x == std::string_view::npos || at == std::string_view::npos || at < x) throw BadValue();
    list.push_back({.width = whole_number(mode.substr(0, x), 1, kMaxSide_px),
                    .height = whole_number(mode.substr(x + 1, at - x - 1), 1, kMaxSide_px),
                    .rate_hz = whole_number(mode.substr(at + 1), 1, kMaxRate_hz)});
  }
  return list;
}

std::vector<Imitation::DepthFormat> depth_units(const std::string& text) {
  using enum Imitation::DepthFormat;
  std::vector<Imitation::DepthFormat> list;
  for (const std::string_view unit : split(text, ',')) {
    list.push_back(one_of<Imitation::DepthFormat>(
        {{"1mm", k1mm}, {"100um", k100um}, {"shift", kShift}}, unit));
  }
  return list;
}

void color_gap(Imitation& imitation, const std::string& text) {
  const auto ends = split(text, '-');
  if (ends.size() != 2) throw BadValue();
  imitation.color_gap_first = whole_number(ends[0], 1, std::numeric_limits<int>::max());
  imitation.color_gap_last =
      whole_number(ends[1], imitation.color_gap_first, std::numeric_limits<int>::max());
}

const std::vector<Option>& options_table() {
  using enum Imitation::Registration;
  using Mirroring = Imitation::Mirroring;
  static const std::vector<Option> table = {
      {"camera", "on|off", [](auto& i, auto& v) { i.camera = on_or_off(v); }},
      {"depth", "on|off", [](auto& i, auto& v) { i.depth = on_or_off(v); }},
      {"color", "on|off", [](auto& i, auto& v) { i.color = on_or_off(v); }},
      {"calibration", "on|off", [](auto& i, auto& v) { i.calibration = on_or_off(v); }},
      {"depth_modes", "WxH@HZ,...", [](auto& i, auto& v) { i.depth_modes = modes(v); }},
      {"color_modes", "WxH@HZ,...", [](auto& i, auto& v) { i.color_modes = modes(v); }},
      {"depth_units", "1mm,100um,shift", [](auto& i, auto& v) { i.depth_units = depth_units(v); }},
      {"refuse_modes", "on|off", [](auto& i, auto& v) { i.refuse_modes = on_or_off(v); }},
      {"registration", "aligned|switchable|off",
       [](auto& i, auto& v) {
         i.registration = one_of<Imitation::Registration>(
             {{"aligned", kAligned}, {"switchable", kSwitchable}, {"off", kOff}}, v);
       }},
      {"mirror", "on|off|stuck",
       [](auto& i, auto& v) {
         i.mirror = one_of<Mirroring>(
             {{"on", Mirroring::kOn}, {"off", Mirroring::kOff}, {"stuck", Mirroring::kStuck}}, v);
       }},
      {"exposure", "on|off", [](auto& i, auto& v) { i.exposure = on_or_off(v); }},
      {"color_drop", "0..1", [](auto& i, auto& v) { i.color_drop = number(v, 0.0, 1.0); }},
      {"color_gap", "FIRST-LAST", [](auto& i, auto& v) { color_gap(i, v); }},
      {"color_delay_ms", "MS", [](auto& i, auto& v) { i.color_delay_us = milliseconds(v, 0.0); }},
      {"color_clock_ms", "MS",
       [](auto& i, auto& v) { i.color_clock_us = milliseconds(v, -kMaxMilliseconds); }},
      {"clock_jump_at", "N", [](auto& i, auto& v) { i.clock_jump_at = count(v); }},
      {"clock_jump_ms", "MS",
       [](auto& i, auto& v) { i.clock_jump_us = milliseconds(v, -kMaxMilliseconds); }},
      {"empty_every", "N", [](auto& i, auto& v) { i.empty_every = count(v); }},
      {"misfit_every", "N", [](auto& i, auto& v) { i.misfit_every = count(v); }},
      {"unplug_at", "N", [](auto& i, auto& v) { i.unplug_at = count(v); }},
      {"replug_after_ms", "MS", [](auto& i, auto& v) { i.replug_after_us = milliseconds(v, 0.0); }},
      {"unplug_silently", "on|off", [](auto& i, auto& v) { i.unplug_silently = on_or_off(v); }},
      {"restart_clock", "on|off", [](auto& i, auto& v) { i.restart_clock = on_or_off(v); }},
      {"new_port", "on|off", [](auto& i, auto& v) { i.new_port = on_or_off(v); }},
      {"port", "N", [](auto& i, auto& v) { i.port = count(v); }},
      {"serial_number", "TEXT", [](auto& i, auto& v) { i.serial_number = v; }},
  };
  return table;
}

}  // namespace

CameraImitation CameraImitation::take_from(std::map<std::string, std::string>& options) {
  CameraImitation imitation;
  for (const Option& option : options_table()) {
    const auto given = options.find(std::string(option.name));
    if (given == options.end()) continue;
    try {
      option.read(imitation, given->second);
    } catch (const BadValue&) {
      throw std::invalid_argument("option " + given->first + " is '" + given->second +
                                  "', expected " + std::string(option.values));
    }
    options.erase(given);
  }
  return imitation;
}

std::string CameraImitation::known_options() {
  std::string list;
  for (const Option& option : options_table()) {
    if (!list.empty()) list += ' ';
    list.append(option.name).append("=").append(option.values);
  }
  return list;
}

}  // namespace kintsugi::mapper
