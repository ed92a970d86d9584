#include "mapper/source/openni2/unread_count.hpp"

#include <algorithm>

namespace kintsugi::mapper {

std::optional<std::string> UnreadCount::update(const UnreadImages& now) {
  const std::int64_t new_depth = now.depth - device_.depth;
  const std::int64_t new_color = now.color - device_.color;
  if (new_depth + new_color == 0) return std::nullopt;
  const bool is_first = total_ == 0;
  device_ = now;
  total_ += new_depth + new_color;
  depth_unexplained_ += new_depth;
  if (!is_first) return std::nullopt;
  return std::string(now.last_reason) +
         "; the image is passed over, as others that cannot be read will be";
}

std::int64_t UnreadCount::explain_gap(std::int64_t missing) {
  const std::int64_t explained = std::min(missing, depth_unexplained_);
  depth_unexplained_ -= explained;
  return explained;
}

std::string UnreadCount::summary() const {
  if (total_ == 0) return "";
  if (total_ == 1) return "1 image of the recording was passed over, as it cannot be read";
  return std::to_string(total_) +
         " images of the recording were passed over, as they cannot be read";
}

}  // namespace kintsugi::mapper
