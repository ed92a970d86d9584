#pragma once
// The index of a bag of ROS 1, which librosbag_storage believes.

#include <filesystem>

namespace kintsugi::mapper {

/// Checks that every entry of the index of a bag leads to a message within its chunk, as far as
/// that can be told without unpacking: the library reads there without asking. Format:
/// http://wiki.ros.org/Bags/Format/2.0
/// @throws std::runtime_error naming the byte and what is wrong
void check_bag_index(const std::filesystem::path& path);

}  // namespace kintsugi::mapper
