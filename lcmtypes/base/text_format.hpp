#pragma once

#include <cstdio>
#include <string>

namespace kintsugi {

/// Formats like printf; the result is cut at 255 characters.
template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

}  // namespace kintsugi
