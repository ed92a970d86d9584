#pragma once
// Flags whose value is a number within bounds, or any that is finite.

#include <cmath>
#include <string>

#include <CLI/CLI.hpp>

namespace kintsugi {

/// Of CLI11's checks: as CLI::Range, which lets NaN through.
inline CLI::Validator number_range(double low, double high) {
  const CLI::Range range(low, high);
  return CLI::Validator(
      [range](std::string& text) -> std::string {
        double number = 0.0;
        const bool is_nan = CLI::detail::lexical_cast(text, number) && std::isnan(number);
        return is_nan ? "'" + text + "' is no number" : range(text);
      },
      range.get_description());
}

/// Refuses NaN and infinity.
inline CLI::Validator finite_number() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        double number = 0.0;
        const bool is_finite = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
        return is_finite ? "" : "'" + text + "' is no finite number";
      },
      "");
}

}  // namespace kintsugi
