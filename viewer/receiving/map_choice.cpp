#include "viewer/receiving/map_choice.hpp"

#include <fmt/format.h>

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::viewer {

bool MapChoice::is_drawn(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (is_open_) {
    name_ = name;
    is_open_ = false;
    is_first_received_ = true;
  }
  if (name == name_) return true;
  ++other_messages_;
  if (others_.size() < kMaxNames && others_.insert(name).second) {
    spdlog::warn("another map is on the bus: \"{}\"; drawing \"{}\"", name, name_);
  }
  return false;
}

std::string MapChoice::problem() const {
  const std::lock_guard lock(mutex_);
  if (!is_first_received_ || others_.empty()) return {};
  return fmt::format(
      "several maps: \"{}\" is drawn, \"{}\" is not ({} messages); choose one by --map-name", name_,
      fmt::join(others_, "\", \""), other_messages_);
}

}  // namespace kintsugi::viewer
