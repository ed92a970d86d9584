#include "lcmtypes/patch_motions.hpp"

namespace kintsugi {
namespace {

/// R v, in the order of terms that every process has.
Eigen::Vector3d rotated(const Eigen::Matrix3d& R, double x, double y, double z) {
  return {(R(0, 0) * x + R(0, 1) * y) + R(0, 2) * z, (R(1, 0) * x + R(1, 1) * y) + R(1, 2) * z,
          (R(2, 0) * x + R(2, 1) * y) + R(2, 2) * z};
}

}  // namespace

std::vector<CloudPoint> moved(std::span<const CloudPoint> points_P, const PatchPose& X_WP) {
  std::vector<CloudPoint> points_W(points_P.begin(), points_P.end());
  if (X_WP.is_identity()) return points_W;
  const Pose X = X_WP.pose();
  const Eigen::Matrix3d R = X.linear();
  const Eigen::Vector3d t = X.translation();
  for (CloudPoint& point : points_W) {
    const Eigen::Vector3d p_W = rotated(R, point.x, point.y, point.z);
    const Eigen::Vector3d n_W = rotated(R, point.nx, point.ny, point.nz);
    point.x = static_cast<float>(p_W.x() + t.x());
    point.y = static_cast<float>(p_W.y() + t.y());
    point.z = static_cast<float>(p_W.z() + t.z());
    point.nx = static_cast<float>(n_W.x());
    point.ny = static_cast<float>(n_W.y());
    point.nz = static_cast<float>(n_W.z());
  }
  return points_W;
}

std::vector<PlacedPatch> PatchMotions::learn(const CloudSlice& correction) {
  std::vector<PlacedPatch> newer;
  for (const PatchMotion& motion : correction.motions) {
    PatchPlace& place = places_[motion.id];
    if (correction.correction <= place.correction) continue;
    place = {motion.X_WP, correction.correction, correction.part};
    newer.push_back({motion.id, place});
  }
  return newer;
}

void PatchMotions::learn(std::int32_t patch_id, const PatchPlace& place) {
  PatchPlace& known = places_[patch_id];
  if (place.correction > known.correction) known = place;
}

PatchPlace PatchMotions::place_of(const CloudSlice& slice) const {
  if (slice.kind != SliceKind::kPatch) return {.X_WP = {}, .correction = 0, .part = slice.part};
  const auto known = places_.find(slice.id);
  if (known != places_.end() && known->second.correction > slice.correction) return known->second;
  return {slice.X_WP, slice.correction, slice.part};
}

void apply_corrections(std::span<CloudSlice* const> slices) {
  PatchMotions motions;
  for (const CloudSlice* const slice : slices) motions.learn(*slice);
  for (CloudSlice* const slice : slices) {
    if (slice->kind != SliceKind::kPatch) continue;
    const auto [X_WP, correction, part] = motions.place_of(*slice);
    slice->X_WP = PatchPose();
    slice->part = part;
    slice->correction = 0;
    if (!X_WP.is_identity()) slice->points_W = moved(slice->points_W, X_WP);
  }
}

}  // namespace kintsugi
