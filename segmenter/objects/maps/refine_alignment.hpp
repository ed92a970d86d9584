#pragma once
// The exact place of one surface on another, from a rough one.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {

/// A surface on which others are placed.
class ReferenceSurface {
 public:
  /// @param samples_A with normals; need not be evenly spaced
  explicit ReferenceSurface(std::vector<CloudPoint> samples_A);

  struct Nearest {
    std::uint32_t index = 0;  ///< of the sample
    float distance_m = 0.0F;
  };
  /// Of each place; the surface is not empty.
  [[nodiscard]] std::vector<Nearest> nearest(std::span<const CloudPoint> places_A) const;
  [[nodiscard]] const std::vector<CloudPoint>& samples() const { return samples_; }

 private:
  std::vector<CloudPoint> samples_;
  NearestNeighbours tree_;
};

struct RefinedAlignment {
  Pose X_AB = Pose::Identity();
  double rms_m = 0.0;      ///< of the distances of matched samples from the tangent planes
  double sigma_m = 0.0;    ///< estimated standard deviation of the position, in the worst direction
  double sigma_rad = 0.0;  ///< and of the rotation
  double matched = 0.0;    ///< share of the samples of B that were matched in the end
};

/// Iterative closest points with point-to-plane distances (Chen and Medioni 1992): matches are
/// within a distance that shrinks from `begin_m` to `end_m`, and of like normals; what has come or
/// gone finds no match and does not count. Nothing: too little is matched, or, unless `may_slide`,
/// not all six degrees are held; a thing that may slide stays where it is in degrees that are not.
std::optional<RefinedAlignment> refine_alignment(const ReferenceSurface& surface_A,
                                                 std::span<const CloudPoint> samples_B,
                                                 const Pose& X_AB, double begin_m, double end_m,
                                                 bool may_slide = false);

}  // namespace kintsugi::segmenter
