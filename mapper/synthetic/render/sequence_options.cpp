// The options in the address of a synthetic scene.
#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::synthetic {

namespace {

struct Argument {
  std::string key;
  std::string value;

  template <typename Number>
  Number number() const {
    Number parsed{};
    const char* end = value.data() + value.size();
    const auto [stopped, error] = std::from_chars(value.data(), end, parsed);
    if (error != std::errc() || stopped != end) {
      fail(std::is_integral_v<Number>
               ? "a whole number up to " + std::to_string(std::numeric_limits<Number>::max())
               : "a number");
    }
    return parsed;
  }

  /// "FROM:TO".
  std::pair<int, int> range() const {
    const std::size_t colon = value.find(':');
    if (colon == std::string::npos) fail("FROM:TO");
    return {Argument{key, value.substr(0, colon)}.number<int>(),
            Argument{key, value.substr(colon + 1)}.number<int>()};
  }

  bool is_on() const {
    if (value != "on" && value != "off") fail("on or off");
    return value == "on";
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throw std::invalid_argument("synthetic: option " + key + " is '" + value + "', expected " +
                                expected);
  }
};

using Config = Sequence::Config;

struct Option {
  std::string key;
  std::string values;  // what it may be, for people
  std::function<void(Config&, const Argument&)> read;
};

std::string joined_sensor_names() {
  std::string list;
  for (const std::string& name : sensor_names()) list += (list.empty() ? "" : "|") + name;
  return list;
}

const std::array<Option, 10>& options_table() {
  static const std::array<Option, 10> kTable = {{
      {"sensor", joined_sensor_names(), [](Config& c, const Argument& a) { c.sensor = a.value; }},
      {"noise", "on|off", [](Config& c, const Argument& a) { c.noise = a.is_on(); }},
      {"speed", "N", [](Config& c, const Argument& a) { c.speed = a.number<double>(); }},
      {"laps", "N", [](Config& c, const Argument& a) { c.laps = a.number<int>(); }},
      {"rate", "30|15|10|6|5|3|2|1",
       [](Config& c, const Argument& a) { c.rate_hz = a.number<int>(); }},
      {"seed", "N", [](Config& c, const Argument& a) { c.seed = a.number<std::uint32_t>(); }},
      {"start", "N", [](Config& c, const Argument& a) { c.start = a.number<int>(); }},
      {"frames", "N", [](Config& c, const Argument& a) { c.frames = a.number<int>(); }},
      {"covered", "FROM:TO", [](Config& c, const Argument& a) { c.covered = a.range(); }},
      {"ground_truth", "FOLDER", [](Config& c, const Argument& a) { c.ground_truth = a.value; }},
  }};
  return kTable;
}

}  // namespace

Config Config::parse(const std::string& scene, const std::map<std::string, std::string>& options) {
  Config config;
  config.scene = scene;
  for (const auto& [key, value] : options) {
    const auto option = std::ranges::find(options_table(), key, &Option::key);
    if (option == options_table().end()) {
      throw std::invalid_argument("synthetic: no option '" + key +
                                  "'; there are: " + known_options());
    }
    option->read(config, {key, value});
  }
  return config;
}

std::string Config::known_options() {
  std::string list;
  for (const Option& option : options_table()) {
    list += (list.empty() ? "" : " ") + option.key + "=" + option.values;
  }
  return list;
}

}  // namespace kintsugi::synthetic
