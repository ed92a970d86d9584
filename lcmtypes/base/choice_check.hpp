#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi {

/// @throws std::invalid_argument with the text "FIELD is 'VALUE', must be one of: A, B", unless
///   `value` is among `known`
inline void require_one_of(std::string_view field, std::string_view value,
                           std::span<const std::string_view> known) {
  if (std::ranges::find(known, value) != known.end()) return;
  std::string message = std::string(field) + " is '" + std::string(value) + "', must be one of";
  const char* separator = ": ";
  for (const std::string_view choice : known) {
    message.append(separator).append(choice);
    separator = ", ";
  }
  require(false, message);
}

}  // namespace kintsugi
