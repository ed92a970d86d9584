#include "segmenter/objects/library/object_name.hpp"

#include <algorithm>

namespace kintsugi::segmenter {
namespace {

/// Whatever the locale.
bool may_be_in_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

}  // namespace

std::optional<std::string> reason_to_refuse_name(std::string_view name) {
  if (name.empty()) return "the name of an object must not be empty";
  if (name.size() > kMaxObjectName) {
    return "the name of an object has " + std::to_string(name.size()) + " characters, at most " +
           std::to_string(kMaxObjectName) + " are possible";
  }
  if (name.front() == '-') return "the name of an object must not begin with '-'";
  if (std::all_of(name.begin(), name.end(), may_be_in_name)) return std::nullopt;
  return "the name of an object must consist of letters, digits, '-' and '_': '" +
         std::string(name) + "'";
}

}  // namespace kintsugi::segmenter
