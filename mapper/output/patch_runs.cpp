#include "mapper/output/patch_runs.hpp"

#include "lcmtypes/patch_motions.hpp"

namespace kintsugi::mapper {

void PatchRuns::append(std::size_t num_points, const std::vector<PatchRun>& runs) {
  const auto add = [&](std::size_t count, int patch) {
    const std::int64_t begin = runs_.empty() ? 0 : runs_.back().end;
    if (runs_.empty() || runs_.back().patch != patch) runs_.push_back({begin, patch});
    runs_.back().end += static_cast<std::int64_t>(count);
  };
  if (runs.empty()) add(num_points, kNoPatch);
  for (const PatchRun& run : runs) add(run.num_points, run.patch);
}

CloudPoint PatchRuns::moved(std::int64_t number, const CloudPoint& point,
                            const PoseOfPatch& pose_of) {
  while (at_ < runs_.size() && runs_[at_].end <= number) {
    ++at_;
    X_WP_.reset();
  }
  if (at_ == runs_.size() || runs_[at_].patch == kNoPatch) return point;
  if (!X_WP_) X_WP_ = pose_of(runs_[at_].patch);
  return kintsugi::moved({&point, 1}, *X_WP_).front();
}

}  // namespace kintsugi::mapper
