#pragma once

#include <charconv>
#include <iterator>
#include <string>

namespace kintsugi {

/// The fewest decimals that identify this float: 0.01 instead of 0.00999999977.
inline std::string shortest_text(float value) {
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  return {std::begin(text), end};
}

/// The double that prints as shortest_text(value).
inline double readable(float value) {
  const std::string text = shortest_text(value);
  double result = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

}  // namespace kintsugi
