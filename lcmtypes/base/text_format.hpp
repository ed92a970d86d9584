#pragma once

#include <cstdio>
#include <string>

namespace kintsugi {

/// As printf, at most 255 characters.
template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

}  // namespace kintsugi
