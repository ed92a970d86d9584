#include "segmenter/objects/library/known_object.hpp"

#include <cstddef>

namespace kintsugi::segmenter {

std::array<double, 12> rows_of(const Pose& pose) {
  std::array<double, 12> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = pose.matrix()(static_cast<int>(i / 4), static_cast<int>(i % 4));
  }
  return rows;
}

Pose pose_of(const std::array<double, 12>& rows) {
  Pose pose = Pose::Identity();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    pose.matrix()(static_cast<int>(i / 4), static_cast<int>(i % 4)) = rows[i];
  }
  return pose;
}

}  // namespace kintsugi::segmenter
