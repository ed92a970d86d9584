#include "mapper/openni2_driver/formats/ros_topics.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <tuple>

namespace kintsugi::mapper::ros1 {
namespace {

constexpr std::string_view kImage = "sensor_msgs/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/CompressedImage";
constexpr std::string_view kCameraInfo = "sensor_msgs/CameraInfo";

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return text;
}

bool contains(const std::string& name, std::string_view word) {
  return lower(name).find(word) != std::string::npos;
}

bool has_images(const Topic& topic) {
  return topic.type == kImage || topic.type == kCompressedImage;
}

bool is_depth(const Topic& topic) {
  if (!has_images(topic) || !contains(topic.name, "depth")) return false;
  // JPEG of depth is of no use; what is not compressedDepth and compressed is JPEG or an 8-bit PNG.
  return topic.type == kImage || topic.name.ends_with("/compressedDepth");
}

bool is_color(const Topic& topic) {
  if (!has_images(topic) || contains(topic.name, "depth") || contains(topic.name, "theora")) {
    return false;
  }
  return contains(topic.name, "color") || contains(topic.name, "rgb") ||
         contains(topic.name, "colour");
}

/// Smaller is better.
std::tuple<bool, bool, std::string> rank(const Topic& topic) {
  return {!is_registered(topic.name), topic.type != kImage, topic.name};
}

std::string list_of(const std::vector<Topic>& topics) {
  std::string text;
  for (const Topic& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
  }
  return text.empty() ? "none" : text;
}

template <typename Accepts>
std::string choose(const std::vector<Topic>& topics, const std::string& chosen, Accepts accepts) {
  if (!chosen.empty()) {
    const bool is_there = std::ranges::any_of(
        topics, [&](const Topic& topic) { return topic.name == chosen && has_images(topic); });
    if (is_there) return chosen;
    throw std::runtime_error("no images in a topic '" + chosen +
                             "'; the bag has: " + list_of(topics));
  }
  const Topic* best = nullptr;
  for (const Topic& topic : topics) {
    if (!accepts(topic)) continue;
    if (best == nullptr || rank(topic) < rank(*best)) best = &topic;
  }
  return best == nullptr ? std::string() : best->name;
}

/// Number of parts of the path that both begin with.
std::size_t common_parts(const std::string& a, const std::string& b) {
  std::size_t parts = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i) {
    if (a[i] == '/') ++parts;
  }
  return parts;
}

/// Whether the folder of a CameraInfo has the images in it.
bool is_of_folder(const std::string& info, const std::string& images) {
  return images.starts_with(info.substr(0, info.rfind('/') + 1));
}

/// The camera of a topic of images is the CameraInfo nearest to it in the tree of names.
std::string camera_of(const std::vector<Topic>& topics, const std::string& images) {
  std::string best;
  for (const Topic& topic : topics) {
    if (topic.type != kCameraInfo) continue;
    const auto parts = common_parts(topic.name, images);
    const auto best_parts = best.empty() ? 0 : common_parts(best, images);
    if (best.empty() || parts > best_parts) best = topic.name;
  }
  return best;
}

}  // namespace

bool is_registered(const std::string& depth_topic) {
  return contains(depth_topic, "registered") || contains(depth_topic, "aligned_depth_to_color");
}

CameraTopics choose_topics(const std::vector<Topic>& topics, const std::string& depth,
                           const std::string& color) {
  CameraTopics chosen;
  chosen.depth = choose(topics, depth, is_depth);
  if (chosen.depth.empty()) {
    throw std::runtime_error("no topic of depth images; the bag has: " + list_of(topics));
  }
  chosen.color = choose(topics, color, is_color);
  chosen.depth_camera = camera_of(topics, chosen.depth);
  if (!chosen.color.empty()) chosen.color_camera = camera_of(topics, chosen.color);
  // What is registered to colour and has no CameraInfo of its own is seen as by the colour camera.
  const bool is_as_color = !chosen.color_camera.empty() && is_registered(chosen.depth) &&
                           !is_of_folder(chosen.depth_camera, chosen.depth);
  if (is_as_color) chosen.depth_camera = chosen.color_camera;
  return chosen;
}

}  // namespace kintsugi::mapper::ros1
