#pragma once
// One linearisation of the alignment of outlines: those of a frame with those of a model.
//
// Frames: C the camera of the frame, V the virtual camera of the model.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/registration/depth_edges.hpp"
#include "mapper/core/registration/information.hpp"

namespace kintsugi::mapper {

struct EdgeAlignmentConfig {
  /// The deviation of an outline's position is that of the residuals, but not below this: an
  /// outline is found between two pixels.
  double min_sigma_px = 0.3;
  double max_distance_px = 8.0;   ///< between the outlines of a pair
  double huber_sigmas = 1.345;    ///< larger residuals are weighted down
  double depth_sigmas = 4.0;      ///< the depths of a pair differ by at most this...
  double max_depth_share = 0.05;  ///< ...and this share of their depth

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Gauss-Newton system of the robust error of outlines
///   E(X_VC) = sum_i rho_Huber((e_i - (u_i - s_i v_i)) / sigma)
/// with (u_i, v_i) the projection of an outline's pixel of the frame and e_i + s_i v the line of
/// the model's outline near it (in columns, u and v change roles). For the left increment of X_VC,
/// as NormalEquations. The second measurement of the direction (see observability.hpp) has the
/// slope of the frame's outline. The errors of neighbouring pixels of an outline are correlated:
/// see independent_edges().
struct EdgeEquations {
  Information information;
  Vector6d b = Vector6d::Zero();
  int pairs = 0;
};

/// `frame_C` and `model_V` are the surfaces in which the edges were found.
EdgeEquations linearize_edges(const DepthEdges& edges_C, const SurfaceMap& frame_C,
                              const DepthEdges& edges_V, const SurfaceMap& model_V,
                              const Pose& X_VC, const EdgeAlignmentConfig& config);

/// The number by which information of outlines is multiplied so that it counts like that of
/// surfaces in an image of so many pixels: an outline crosses patches (see kIndependentPatches) as
/// long as they are wide, while a surface fills their area.
double weight_of_edges(std::size_t num_pixels);

}  // namespace kintsugi::mapper
