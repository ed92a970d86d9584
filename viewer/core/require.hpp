#pragma once

#include <sstream>
#include <stdexcept>

namespace kintsugi::viewer {

/// For validate(): throws std::invalid_argument naming the field, its value and the bound.
template <class Value>
void require(bool ok, const char* field, const Value& value, const char* bound) {
  if (ok) return;
  std::ostringstream text;
  text << field << " is " << value << ", expected " << bound;
  throw std::invalid_argument(text.str());
}

}  // namespace kintsugi::viewer
