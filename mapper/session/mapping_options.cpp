#include "mapper/session/mapping_options.hpp"

#include <stdexcept>

#include <spdlog/fmt/fmt.h>

namespace kintsugi::mapper {
namespace {

std::string value_of(const MappingOptions& options, const std::string& name) {
  const auto found = options.find(name);
  return found == options.end() ? "not known" : "'" + found->second + "'";
}

}  // namespace

void expect_same_options(const MappingOptions& now, const MappingOptions& then) {
  std::string differences;
  for (const auto& [name, value] : now) {
    const std::string value_then = value_of(then, name);
    if (value_then == "'" + value + "'") continue;
    differences += fmt::format("{}{} is '{}', was {}", differences.empty() ? "" : "; ", name, value,
                               value_then);
  }
  if (!differences.empty()) {
    throw std::runtime_error("a session must be resumed with the options it was begun with: " +
                             differences);
  }
}

}  // namespace kintsugi::mapper
