#pragma once

#include <optional>
#include <string>

#include "lcmtypes/geometry.hpp"

namespace rosbag {
class Bag;
}

namespace kintsugi::mapper::ros1 {

/// Pose of the frame `child` in the frame `parent`, from /tf_static, in any number of steps and
/// either direction; nullopt when the bag does not have it.
std::optional<Pose> fixed_transform(const rosbag::Bag& bag, const std::string& parent,
                                    const std::string& child);

}  // namespace kintsugi::mapper::ros1
