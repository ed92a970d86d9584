#include "mapper/output/patch_runs.hpp"

#include <algorithm>

#include "lcmtypes/patch_motions.hpp"

namespace kintsugi::mapper {

void PatchRuns::append(std::size_t num_points, const std::vector<PatchRun>& runs) {
  const auto add = [&](std::size_t count, int patch) {
    const std::int64_t begin = runs_.empty() ? 0 : runs_.back().end;
    if (runs_.empty() || runs_.back().patch != patch) runs_.push_back({begin, patch, {}, 0});
    runs_.back().end += static_cast<std::int64_t>(count);
  };
  if (runs.empty()) add(num_points, kNoPatch);
  for (const PatchRun& run : runs) add(run.num_points, run.patch);
}

void PatchRuns::place(const PoseOfPatch& pose_of) {
  std::int64_t begin = 0;
  std::int64_t num_dropped = 0;
  for (Run& run : runs_) {
    run.X_WP = run.patch == kNoPatch ? PatchPose() : pose_of(run.patch);
    run.num_dropped = num_dropped;
    if (!run.X_WP) num_dropped += run.end - begin;
    begin = run.end;
  }
}

std::optional<CloudPoint> PatchRuns::moved(std::int64_t number, const CloudPoint& point) const {
  const Run& run = run_of(number);
  if (!run.X_WP) return std::nullopt;
  return kintsugi::moved({&point, 1}, *run.X_WP).front();
}

std::optional<std::int64_t> PatchRuns::number_of_kept(std::int64_t number) const {
  const Run& run = run_of(number);
  return run.X_WP ? std::optional(number - run.num_dropped) : std::nullopt;
}

const PatchRuns::Run& PatchRuns::run_of(std::int64_t number) const {
  return *std::ranges::upper_bound(runs_, number, {}, &Run::end);
}

}  // namespace kintsugi::mapper
