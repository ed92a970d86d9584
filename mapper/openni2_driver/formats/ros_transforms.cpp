#include "mapper/openni2_driver/formats/ros_transforms.hpp"

#include <deque>
#include <map>
#include <utility>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "mapper/openni2_driver/formats/ros_messages.hpp"

namespace kintsugi::mapper::ros1 {
namespace {

/// For each frame its neighbours, and their poses in it.
using Frames = std::map<std::string, std::vector<std::pair<std::string, Pose>>>;

/// Older releases began names with a slash.
std::string without_slash(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

void add(Frames& frames, const TransformStamped& stamped) {
  const auto& t = stamped.transform.translation;
  const auto& r = stamped.transform.rotation;
  const Eigen::Quaterniond q(r.w, r.x, r.y, r.z);
  if (!(q.norm() > 0.5 && q.norm() < 2.0)) return;
  Pose X_PC = Pose::Identity();
  X_PC.linear() = q.normalized().toRotationMatrix();
  X_PC.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  if (!X_PC.matrix().allFinite()) return;
  const std::string parent = without_slash(plain(stamped.header.frame_id));
  const std::string child = without_slash(plain(stamped.child_frame_id));
  frames[parent].emplace_back(child, X_PC);
  frames[child].emplace_back(parent, X_PC.inverse(Eigen::Isometry));
}

}  // namespace

std::optional<Pose> fixed_transform(const rosbag::Bag& bag, const std::string& parent,
                                    const std::string& child) {
  Frames frames;
  for (const rosbag::MessageInstance& message :
       rosbag::View(bag, rosbag::TopicQuery(std::vector<std::string>{"/tf_static"}))) {
    const auto transforms = message.instantiate<TFMessage>();
    if (!transforms) continue;
    for (const TransformStamped& stamped : transforms->transforms) add(frames, stamped);
  }
  std::map<std::string, Pose> found = {{without_slash(parent), Pose::Identity()}};
  std::deque<std::string> waiting = {without_slash(parent)};
  while (!waiting.empty()) {
    const std::string frame = waiting.front();
    waiting.pop_front();
    for (const auto& [name, X_FN] : frames[frame]) {
      if (!found.emplace(name, found.at(frame) * X_FN).second) continue;
      waiting.push_back(name);
    }
  }
  const auto pose = found.find(without_slash(child));
  return pose == found.end() ? std::nullopt : std::optional(pose->second);
}

}  // namespace kintsugi::mapper::ros1
