#include "tests/support/corrected_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace kintsugi::testing {
namespace {

constexpr std::int32_t kNoId = -1;
constexpr std::int64_t kFirstUtime = 1'000'000;
constexpr std::int64_t kBatchPeriod_us = 100'000;

}  // namespace

CorrectedMap::CorrectedMap(const PlayedMap& map, const Config& config) : map_(map) {
  const std::int32_t num_patches = map.num_slices() - 1;
  ids_.resize(static_cast<std::size_t>(num_patches), kNoId);
  revisions_.resize(ids_.size());
  for (std::int32_t first = 0; first < num_patches; first += config.batch_patches) {
    const std::int32_t end = std::min(first + config.batch_patches, num_patches);
    send(first, end);
    const std::int64_t due = std::int64_t{config.num_corrections} * end / num_patches;
    if (due > num_corrections_) {
      correct(end);
      send(first, end);
    }
  }
  Step last;
  last.kind = SliceKind::kFinal;
  last.id = next_id_;
  last.patch = num_patches;
  last.batch = num_batches_;
  steps_.push_back(last);
}

/// A batch; patches that were sent before come in the next revision.
void CorrectedMap::send(std::int32_t first_patch, std::int32_t end_patch) {
  for (std::int32_t patch = first_patch; patch < end_patch; ++patch) {
    std::int32_t& id = ids_.at(static_cast<std::size_t>(patch));
    std::int32_t& revision = revisions_.at(static_cast<std::size_t>(patch));
    if (id == kNoId) {
      id = next_id_++;
    } else {
      ++revision;
    }
    steps_.push_back({id, patch, revision, num_corrections_, num_batches_, SliceKind::kPatch,
                      patch + 1 == end_patch});
  }
  ++num_batches_;
}

void CorrectedMap::correct(std::int32_t num_patches) {
  ++num_corrections_;
  steps_.push_back(
      {next_id_++, num_patches, 0, num_corrections_, num_batches_++, SliceKind::kCorrection, true});
}

CloudSlice CorrectedMap::slice(std::size_t step_index) const {
  const Step& step = steps_.at(step_index);
  const bool is_correction = step.kind == SliceKind::kCorrection;
  CloudSlice slice = is_correction ? correction(step) : map_.slice(step.patch, step.revision);
  slice.id = step.id;
  slice.kind = step.kind;
  slice.utime = kFirstUtime + kBatchPeriod_us * step.batch;
  slice.ends_batch = step.ends_batch;
  if (step.kind == SliceKind::kPatch) {
    slice.in_volume = true;
    slice.correction = step.correction;
    slice.X_WP = pose_of(step.patch, step.correction);
  } else if (step.kind == SliceKind::kFinal) {
    slice.revision_sum = std::accumulate(revisions_.begin(), revisions_.end(), std::int64_t{0});
  }
  return slice;
}

CloudSlice CorrectedMap::correction(const Step& step) const {
  CloudSlice slice = map_.slice(step.patch - 1);
  slice.points_W.clear();
  slice.correction = step.correction;
  slice.X_WP = pose_of(step.patch, step.correction);
  for (std::int32_t patch = 1; patch < step.patch; ++patch) {
    slice.motions.push_back(
        {ids_.at(static_cast<std::size_t>(patch)), pose_of(patch, step.correction)});
  }
  return slice;
}

/// To and fro, so that the map stays near where it was, however often it is corrected.
PatchPose CorrectedMap::pose_of(std::int32_t patch, std::int32_t correction) const {
  if (correction == 0) return {};
  const double bend = (correction % 2 == 0 ? -1.0 : 1.0) * (1.0 + 0.1 * correction) * patch /
                      static_cast<double>(ids_.size());
  Pose X_WP = Pose::Identity();
  X_WP.linear() = Eigen::AngleAxisd(0.002 * bend, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X_WP.translation() << 0.03 * bend, -0.02 * bend, 0.01 * bend;
  return X_WP;
}

}  // namespace kintsugi::testing
