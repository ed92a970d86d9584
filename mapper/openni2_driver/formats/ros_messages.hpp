#pragma once
// The messages of ROS 1 that a camera sends, as types that C++20 can compile.

#include <memory>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

namespace kintsugi::mapper::ros1 {

/// ROS 1's generated messages use std::allocator's rebind, which C++20 does not have any more.
template <typename T>
struct Allocator : std::allocator<T> {
  Allocator() = default;
  template <typename Other>
  Allocator(const Allocator<Other>& /*other*/) {}  // NOLINT(google-explicit-constructor)
  template <typename Other>
  struct rebind {
    using other = Allocator<Other>;
  };
};

using Image = sensor_msgs::Image_<Allocator<void>>;
using CompressedImage = sensor_msgs::CompressedImage_<Allocator<void>>;
using CameraInfo = sensor_msgs::CameraInfo_<Allocator<void>>;
using TransformStamped = geometry_msgs::TransformStamped_<Allocator<void>>;
using TFMessage = tf2_msgs::TFMessage_<Allocator<void>>;

/// Text of a message, in the usual type.
template <typename Text>
std::string plain(const Text& text) {
  return {text.data(), text.size()};
}

}  // namespace kintsugi::mapper::ros1
