#pragma once
// Prepares a cloud of unknown origin for segmentation.

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/preprocess/normals.hpp"

namespace kintsugi::segmenter {

/// Scales normals whose length differs from 1 by more than 1e-4 to length 1, and returns how many.
/// Normals that are not finite or shorter than 1e-6 stay as they are: they will be rejected.
std::int64_t normalize_normals(std::span<CloudPoint> points_W);

/// estimate_normals() over the points whose position is admissible.
void compute_normals(std::span<CloudPoint> points_W, const NormalsConfig& config,
                     const std::function<void(double)>& progress);

/// estimate_missing_normals() over the same points.
void compute_missing_normals(std::span<CloudPoint> points_W, const NormalsConfig& config);

/// How many points lack a normal, of those whose position is admissible, and how many those are.
struct NormalCount {
  std::int64_t num_missing = 0;
  std::int64_t num_points = 0;
};
NormalCount count_missing_normals(std::span<const CloudPoint> points_W);

/// Within which computed normals are averaged, the same as in the mapper.
inline constexpr float kAveragingRadius_vox = 2.0F;

/// Replaces each normal by the mean of its own and those of the points closer than `radius_m` (> 0)
/// that do not face away from it (n . n' > 0), scaled to length 1. This reduces noise and keeps the
/// two sides of a thin board apart. Points that cannot be segmented, for instance those without a
/// normal, are ignored. The result does not depend on the number of threads.
void average_normals(std::span<CloudPoint> points_W, float radius_m);

/// median_spacing_m() of the points whose position is admissible.
float usable_spacing_m(std::span<const CloudPoint> points_W);

struct Rejection {
  std::string_view reason;        ///< as returned by reason_to_reject()
  std::int64_t count = 0;         ///< points rejected for it
  std::int64_t first_vertex = 0;  ///< index of the first of them
};

/// The points that a segment map will reject, by reason, in order of the first point.
std::vector<Rejection> count_rejections(std::span<const CloudPoint> points_W);

}  // namespace kintsugi::segmenter
