#pragma once

#include <sstream>
#include <stdexcept>
#include <string_view>

namespace kintsugi::mapper {

/// For the validate() of a Config.
/// @throws std::invalid_argument "FIELD is VALUE, must be within [LOWEST, HIGHEST]"; NaN fails
template <typename T>
void check_range(std::string_view field, T value, T lowest, T highest) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream message;
  message << field << " is " << value << ", must be within [" << lowest << ", " << highest << "]";
  throw std::invalid_argument(message.str());
}

}  // namespace kintsugi::mapper
