#pragma once
// Which topics of a bag have the depth, the colour and the cameras.

#include <string>
#include <vector>

namespace kintsugi::mapper::ros1 {

struct Topic {
  std::string name;
  std::string type;  ///< as sensor_msgs/Image
};

struct CameraTopics {
  std::string depth;
  std::string depth_camera;  ///< of its sensor_msgs/CameraInfo
  std::string color;         ///< empty: there is none
  std::string color_camera;
};

/// @param depth topic of the depth images, empty: the one whose name says that it is depth, if
///   possible registered to colour, if possible not compressed
/// @param color the same of colour
/// @throws std::runtime_error naming the topics that there are, when the choice is not in the bag
/// or
///   nothing looks like depth
CameraTopics choose_topics(const std::vector<Topic>& topics, const std::string& depth,
                           const std::string& color);

/// True where the name of a depth topic says that its pixels are those of the colour camera.
bool is_registered(const std::string& depth_topic);

}  // namespace kintsugi::mapper::ros1
