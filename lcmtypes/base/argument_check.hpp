#pragma once
// Checks of arguments and configurations. Every error names the field, its value and the bound.

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kintsugi {

/// @throws std::invalid_argument with the text "FIELD is VALUE, must be BOUND", unless `holds`
template <typename T>
void require(bool holds, std::string_view field, const T& value, std::string_view bound) {
  if (holds) return;
  std::ostringstream message;
  message << field << " is " << value << ", must be " << bound;
  throw std::invalid_argument(message.str());
}

/// @throws std::invalid_argument with the text `message`, unless `holds`
inline void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument(message);
}

/// @throws std::invalid_argument unless lowest <= value <= highest; NaN fails
template <typename T>
void check_range(std::string_view field, T value, T lowest, T highest) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream bound;
  bound << "within [" << lowest << ", " << highest << "]";
  require(false, field, value, bound.str());
}

}  // namespace kintsugi
