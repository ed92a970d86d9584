#pragma once
// JSON as text.

#include <string>

namespace kintsugi {

/// Bytes that are no UTF-8, as the name of a file or of a map may have, are replaced: nlohmann's
/// dump() alone throws.
/// @param indent blanks for each level; negative: all on one line
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kintsugi
