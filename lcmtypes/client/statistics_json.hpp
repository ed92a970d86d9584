#pragma once
// Statistics of a segment as JSON, with the same keys in every file and program.

#include <cstdint>

#include <nlohmann/json.hpp>

#include "lcmtypes/base/number_text.hpp"
#include "lcmtypes/segment_messages.hpp"

namespace kintsugi {

inline nlohmann::ordered_json statistic_json(float value) { return readable(value); }
inline nlohmann::ordered_json statistic_json(std::int32_t value) { return value; }
inline nlohmann::ordered_json statistic_json(std::uint32_t value) { return value; }
inline nlohmann::ordered_json statistic_json(const std::uint8_t (&color)[3]) {
  return {color[0], color[1], color[2]};
}
/// Three numbers, each with the fewest decimals that identify the float.
inline nlohmann::ordered_json vector_json(const float (&v)[3]) {
  return {readable(v[0]), readable(v[1]), readable(v[2])};
}

inline nlohmann::ordered_json statistic_json(const float (&v)[3]) { return vector_json(v); }

/// The fields in the order of their list, with their names as keys.
inline nlohmann::ordered_json statistics_json(const SegmentStatistics& statistics) {
  nlohmann::ordered_json json;
  SegmentStatistics::visit_fields(
      [&json](const StatisticsField& field, const auto& value) {
        json[field.name] = statistic_json(value);
      },
      statistics);
  return json;
}

}  // namespace kintsugi
