#pragma once
// Checks the statistics of a segment: the same record is in updates and in answers.

#include <cmath>
#include <string>

#include "lcmtypes/codec/check.hpp"

namespace kintsugi::codec {

inline void check_statistic(const Check& check, const StatisticsField& field, float value) {
  if (std::isfinite(value)) return;
  check.fail(std::string("statistics ").append(field.name).c_str(), value, "a finite number");
}
inline void check_statistic(const Check& check, const StatisticsField& field,
                            const float (&values)[3]) {
  for (const float value : values) check_statistic(check, field, value);
}
inline void check_statistic(const Check& check, const StatisticsField& field, std::int32_t value) {
  if (value >= 0) return;
  check.fail(std::string("statistics ").append(field.name).c_str(), value, ">= 0");
}
// Every unsigned value is valid.
inline void check_statistic(const Check&, const StatisticsField&, std::uint32_t) {}
inline void check_statistic(const Check&, const StatisticsField&, const std::uint8_t (&)[3]) {}

inline void check_statistics(const Check& check, const SegmentStatistics& statistics) {
  SegmentStatistics::visit_fields(
      [&check](const StatisticsField& field, const auto& value) {
        check_statistic(check, field, value);
      },
      statistics);
}

}  // namespace kintsugi::codec
