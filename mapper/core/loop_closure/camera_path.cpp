#include "mapper/core/loop_closure/camera_path.hpp"

namespace kintsugi::mapper {
namespace {

Pose between(const Pose& X_WA, const Pose& X_WB, double share) {
  Pose X = Pose::Identity();
  X.translation() = (1.0 - share) * X_WA.translation() + share * X_WB.translation();
  X.linear() = Eigen::Quaterniond(X_WA.linear())
                   .slerp(share, Eigen::Quaterniond(X_WB.linear()))
                   .toRotationMatrix();
  return X;
}

}  // namespace

CameraPath::Step::Step(std::int64_t time, const Pose& X_UC)
    : utime(time),
      t_UC(X_UC.translation()),
      q_UC(Eigen::Quaterniond(X_UC.linear()).cast<float>()) {}

Pose CameraPath::Step::X_UC() const {
  Pose X = Pose::Identity();
  X.translation() = t_UC;
  X.linear() = q_UC.cast<double>().normalized().toRotationMatrix();
  return X;
}

void CameraPath::add(std::int64_t utime, const Pose& X_UC, int keyframe, bool jumped) {
  if (!steps_.empty() && !jumped) {
    length_m_ += (X_UC.translation() - steps_.back().t_UC).norm();
  }
  if (stays_.empty() || jumped || stays_.back().keyframe != keyframe) {
    stays_.push_back({keyframe, steps_.size(), jumped});
  }
  steps_.emplace_back(utime, X_UC);
}

std::map<int, Trajectory> CameraPath::corrected(const MapDeformation& deformation) const {
  std::map<int, Trajectory> paths;
  for (std::size_t s = 0; s < stays_.size(); ++s) {
    const bool is_last = s + 1 == stays_.size();
    const std::size_t end = is_last ? steps_.size() : stays_[s + 1].first;
    const bool goes_over = !is_last && !stays_[s + 1].jumped;
    Trajectory& path = paths[deformation.part_of(stays_[s].keyframe)];
    const Pose here = deformation.at(stays_[s].keyframe);
    const Pose next = goes_over ? deformation.at(stays_[s + 1].keyframe) : here;
    const std::int64_t begin_utime = steps_[stays_[s].first].utime;
    const std::int64_t duration_us = goes_over ? steps_[end].utime - begin_utime : 1;
    for (std::size_t i = stays_[s].first; i < end; ++i) {
      const Step& step = steps_[i];
      const double share =
          static_cast<double>(step.utime - begin_utime) / static_cast<double>(duration_us);
      const Pose X_UC = step.X_UC();
      path.push_back(
          {step.utime, goes_over ? between(here * X_UC, next * X_UC, share) : here * X_UC});
    }
  }
  return paths;
}

}  // namespace kintsugi::mapper
