#include "segmenter/objects/model/shortest_rotation.hpp"

namespace kintsugi::segmenter {

Eigen::Quaterniond shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace kintsugi::segmenter
