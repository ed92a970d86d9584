#pragma once
// How a pixel sees its surface: at which angle, and beside which other surface.

#include <optional>

#include "mapper/synthetic/scene/rendered_frame.hpp"

namespace kintsugi::synthetic {

/// The angles at which the rays of a frame meet the surfaces.
class IncidenceAngles {
 public:
  /// Keeps a reference to the frame.
  explicit IncidenceAngles(const RenderedFrame& frame);

  /// Cosine of the angle between the ray and the surface's normal; negative from behind. The pixel
  /// must see a surface.
  double cosine(int v, int u) const;

 private:
  const RenderedFrame& frame_;
  Eigen::Matrix3d R_CW_;
};

/// Whether a neighbour (of four) is at another depth, by more than the share `ratio` of the pixel's
/// own, or has none.
bool at_depth_edge(const cv::Mat_<float>& depth_m, int v, int u, double ratio);

/// Of the neighbours (of four) for which at_depth_edge() holds and which have a depth, that of the
/// one whose depth differs most, metres.
std::optional<float> depth_across_edge(const cv::Mat_<float>& depth_m, int v, int u, double ratio);

}  // namespace kintsugi::synthetic
