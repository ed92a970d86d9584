#include "segmenter/objects/library/object_json.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/base/number_text.hpp"
#include "lcmtypes/geometry.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;  // for writing: it looks keys up one by one
constexpr const char* kFormat = "kintsugi object";

[[noreturn]] void fail(const std::string& key, const std::string& expected) {
  throw std::runtime_error("key '" + key + "': expected " + expected);
}

const Json& at(const Json& json, const std::string& key) {
  if (!json.is_object()) throw std::runtime_error("expected an object with the key '" + key + "'");
  const auto found = json.find(key);
  if (found == json.end()) throw std::runtime_error("the key '" + key + "' is missing");
  return *found;
}

std::string text(const Json& json, const std::string& key) {
  const Json& value = at(json, key);
  if (!value.is_string()) fail(key, "a text");
  return value.get<std::string>();
}

bool truth(const Json& json, const std::string& key) {
  const Json& value = at(json, key);
  if (!value.is_boolean()) fail(key, "true or false");
  return value.get<bool>();
}

double number(const Json& json, const std::string& key) {
  const Json& value = at(json, key);
  constexpr double kMost = 1e30;  // float32 can hold it
  if (!value.is_number() || !(std::abs(value.get<double>()) <= kMost)) fail(key, "a number");
  return value.get<double>();
}

/// @param json the value itself
std::int64_t whole(const Json& json, const std::string& key, std::int64_t lowest,
                   std::int64_t highest) {
  const std::string expected =
      "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
  if (!json.is_number_integer()) fail(key, expected);
  if (json.is_number_unsigned() &&
      json.get<std::uint64_t>() > static_cast<std::uint64_t>(highest)) {
    fail(key, expected);
  }
  const auto value = json.get<std::int64_t>();
  if (value < lowest || value > highest) fail(key, expected);
  return value;
}

const Json& list(const Json& json, const std::string& key) {
  const Json& value = at(json, key);
  if (!value.is_array()) fail(key, "a list");
  return value;
}

std::string crc_text(std::uint32_t crc32) {
  std::array<char, 9> hex{};
  std::snprintf(hex.data(), hex.size(), "%08x", crc32);
  return hex.data();
}

std::uint32_t crc_of(const Json& json, const std::string& key) {
  const std::string hex = text(json, key);
  std::uint32_t crc32 = 0;
  const auto end = std::from_chars(hex.data(), hex.data() + hex.size(), crc32, 16);
  if (hex.size() != 8 || end.ec != std::errc() || end.ptr != hex.data() + hex.size()) {
    fail(key, "8 digits of a hexadecimal number");
  }
  return crc32;
}

constexpr const char* kTimeFormat = "%Y-%m-%dT%H:%M:%SZ";

std::string time_text(std::int64_t time_s) {
  const auto time = static_cast<std::time_t>(time_s);
  std::tm utc{};
  std::array<char, 64> text{};
  if (gmtime_r(&time, &utc) == nullptr ||
      std::strftime(text.data(), text.size(), kTimeFormat, &utc) == 0) {
    throw std::runtime_error("a lesson's time cannot be written: " + std::to_string(time_s));
  }
  return text.data();
}

std::int64_t time_of(const Json& json, const std::string& key) {
  const std::string written = text(json, key);
  std::tm utc{};
  const char* const end = strptime(written.c_str(), kTimeFormat, &utc);
  if (end == nullptr || end != written.c_str() + written.size()) {
    fail(key, "a time such as 2026-01-31T12:00:00Z");
  }
  return timegm(&utc);
}

OrderedJson vector_json(const Eigen::Vector3f& v) {
  return {readable(v.x()), readable(v.y()), readable(v.z())};
}

Eigen::Vector3f vector_of(const Json& json, const std::string& key) {
  if (!json.is_array() || json.size() != 3) fail(key, "three numbers");
  Eigen::Vector3f v;
  for (int i = 0; i < 3; ++i) {
    const Json& value = json[static_cast<std::size_t>(i)];
    if (!value.is_number() || !(std::abs(value.get<double>()) <= 1e6)) fail(key, "three numbers");
    v[i] = static_cast<float>(value.get<double>());
  }
  return v;
}

OrderedJson size_json(const ObjectModel& model) {
  Eigen::AlignedBox3f box_O;
  for (const CloudPoint& p : model.points_O) box_O.extend(Eigen::Vector3f(p.x, p.y, p.z));
  const Eigen::Vector3f size_m = box_O.sizes();
  OrderedJson json = OrderedJson::array();
  for (const float side_m : size_m) json.push_back(std::round(1e3 * side_m) / 1e3);
  return json;
}

OrderedJson color_json(const ObjectModel& model) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : model.points_O) sum += Eigen::Vector3d(p.red, p.green, p.blue);
  OrderedJson json = OrderedJson::array();
  for (const double channel : sum) {
    json.push_back(std::lround(channel / static_cast<double>(model.points_O.size())));
  }
  return json;
}

OrderedJson parameters_json(const EngineConfig& config) {
  OrderedJson json;
  for (const EngineParameter& parameter : kMapParameters) {
    json[std::string(parameter.name)] = config.*parameter.value;
  }
  return json;
}

EngineConfig parameters_of(const Json& json) {
  EngineConfig config;
  for (const EngineParameter& parameter : kMapParameters) {
    config.*parameter.value = number(json, std::string(parameter.name));
  }
  return config;
}

OrderedJson lesson_json(const Lesson& lesson) {
  OrderedJson json;
  json["time"] = time_text(lesson.time_s);
  json["map"] = lesson.map_name;
  json["session"] = lesson.map_session;
  json["segments"] = lesson.segment_ids;
  if (lesson.X_WO) json["X_WO"] = *lesson.X_WO;
  return json;
}

std::array<double, 12> rows_of_pose(const Json& json, const std::string& key) {
  std::array<double, 12> rows{};
  const std::string expected = "12 numbers, the rows of a 3 x 4 matrix";
  if (!json.is_array() || json.size() != rows.size()) fail(key, expected);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!json[i].is_number() || !(std::abs(json[i].get<double>()) <= kMaxPosition_m)) {
      fail(key, expected);
    }
    rows[i] = json[i].get<double>();
  }
  return rows;
}

Lesson lesson_of(const Json& json) {
  Lesson lesson;
  lesson.time_s = time_of(json, "time");
  lesson.map_name = text(json, "map");
  lesson.map_session =
      whole(at(json, "session"), "session", 0, std::numeric_limits<std::int64_t>::max());
  if (json.contains("X_WO")) lesson.X_WO = rows_of_pose(json["X_WO"], "X_WO");
  const Json& ids = list(json, "segments");
  lesson.segment_ids.reserve(ids.size());
  for (const Json& id : ids) {
    lesson.segment_ids.push_back(static_cast<std::uint32_t>(
        whole(id, "segments", 1, std::numeric_limits<std::uint32_t>::max())));
  }
  return lesson;
}

/// As hexadecimal digits: four cells each, the first in the lowest bit.
std::string digits_of(const std::vector<bool>& cells) {
  std::string digits((cells.size() + 3) / 4, '0');
  for (std::size_t digit = 0; digit < digits.size(); ++digit) {
    unsigned value = 0;
    for (std::size_t bit = 0; bit < 4 && 4 * digit + bit < cells.size(); ++bit) {
      value |= (cells[4 * digit + bit] ? 1U : 0U) << bit;
    }
    digits[digit] = "0123456789abcdef"[value];
  }
  return digits;
}

OrderedJson empty_json(const EmptySpace& empty_O) {
  OrderedJson json;
  json["low_O"] = vector_json(empty_O.low_O());
  json["cell_m"] = readable(empty_O.cell_m());
  json["size"] = {empty_O.size().x(), empty_O.size().y(), empty_O.size().z()};
  json["cells"] = digits_of(empty_O.is_empty());
  return json;
}

EmptySpace empty_of(const Json& json) {
  const Json& sides = list(json, "size");
  if (sides.size() != 3) fail("size", "three whole numbers");
  Eigen::Vector3i size;
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<int>(
        whole(sides[static_cast<std::size_t>(axis)], "size", 1, EmptySpace::kMostCells));
  }
  const auto num_cells = static_cast<std::size_t>(size.prod());
  const std::string digits = text(json, "cells");
  if (digits.size() != (num_cells + 3) / 4 ||
      digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
    fail("cells", std::to_string((num_cells + 3) / 4) + " hexadecimal digits");
  }
  std::vector<bool> cells(num_cells);
  for (std::size_t i = 0; i < num_cells; ++i) {
    const char digit = digits[i / 4];
    const int value = digit <= '9' ? digit - '0' : digit - 'a' + 10;
    cells[i] = ((value >> (i % 4)) & 1) != 0;
  }
  const auto cell_m = static_cast<float>(number(json, "cell_m"));
  if (!(cell_m > 0.0F)) fail("cell_m", "a number above 0");
  return {vector_of(at(json, "low_O"), "low_O"), cell_m, size, std::move(cells)};
}

/// A list with a line for each entry; dump(2) would give each number a line of its own.
std::string lines(const OrderedJson& list) {
  std::string text;
  for (const OrderedJson& entry : list)
    text += (text.empty() ? "\n    " : ",\n    ") + json_text(entry);
  return "[" + text + (list.empty() ? "]" : "\n  ]");
}

Json parse(std::string_view text) {
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::exception& error) {  // also of a number that is too large
    throw std::runtime_error(std::string("is no JSON: ") + error.what());
  }
}

void check_format(const Json& json) {
  if (!json.is_object() || !json.contains("format") || json["format"] != kFormat) {
    throw std::runtime_error(std::string("is no object of a library: expected the key 'format' "
                                         "with the value '") +
                             kFormat + "'");
  }
  const auto version =
      whole(at(json, "version"), "version", 1, std::numeric_limits<std::int32_t>::max());
  if (version > kObjectVersion) {
    throw std::runtime_error("has version " + std::to_string(version) +
                             ", this program knows versions up to " +
                             std::to_string(kObjectVersion));
  }
}

KnownObject object_of(const Json& json) {
  constexpr std::int64_t kMaxTimes = std::numeric_limits<std::int32_t>::max();
  KnownObject object;
  object.model.name = text(json, "name");
  object.model.resolution_m = static_cast<float>(number(json, "resolution_m"));
  object.model.has_up = truth(json, "has_up");
  object.model.times_taught =
      static_cast<std::int32_t>(whole(at(json, "times_taught"), "times_taught", 1, kMaxTimes));
  object.wholeness = number(json, "wholeness");
  object.model.parameters = parameters_of(at(json, "parameters"));
  for (const Json& lesson : list(json, "lessons")) object.lessons.push_back(lesson_of(lesson));
  const Json& views_O = list(json, "views_O");
  object.model.views_O.reserve(views_O.size());
  for (const Json& view_O : views_O) {
    object.model.views_O.push_back(vector_of(view_O, "views_O"));
  }
  if (json.contains("empty_O")) object.model.empty_O = empty_of(json["empty_O"]);
  return object;
}

}  // namespace

std::string object_json(const KnownObject& object, std::uint32_t model_crc32) {
  const ObjectModel& model = object.model;
  std::string text = "{";
  const auto add = [&text](const char* key, const std::string& value) {
    text += std::string(text.size() == 1 ? "\n  \"" : ",\n  \"") + key + "\": " + value;
  };
  OrderedJson lessons = OrderedJson::array();
  for (const Lesson& lesson : object.lessons) lessons.push_back(lesson_json(lesson));
  OrderedJson views_O = OrderedJson::array();
  for (const Eigen::Vector3f& view_O : model.views_O) views_O.push_back(vector_json(view_O));
  add("format", Json(kFormat).dump());
  add("version", Json(kObjectVersion).dump());
  add("name", Json(model.name).dump());
  add("size_m", size_json(model).dump());
  add("mean_color", color_json(model).dump());
  add("points", Json(model.points_O.size()).dump());
  add("resolution_m", Json(readable(model.resolution_m)).dump());
  add("has_up", Json(model.has_up).dump());
  add("times_taught", Json(model.times_taught).dump());
  add("wholeness", Json(object.wholeness).dump());
  add("parameters", parameters_json(model.parameters).dump());
  add("model_crc32", Json(crc_text(model_crc32)).dump());
  add("lessons", lines(lessons));
  add("views_O", lines(views_O));
  if (!model.empty_O.is_unknown()) add("empty_O", json_text(empty_json(model.empty_O)));
  return text + "\n}\n";
}

ObjectDocument parse_object_json(std::string_view text) {
  const Json json = parse(text);
  check_format(json);
  ObjectDocument document;
  document.object = object_of(json);
  document.num_points = static_cast<std::uint64_t>(
      whole(at(json, "points"), "points", 1, std::numeric_limits<std::int64_t>::max()));
  document.model_crc32 = crc_of(json, "model_crc32");
  return document;
}

}  // namespace kintsugi::segmenter
