#pragma once
// A Gauss-Newton step of registration: by surfaces in the directions that they determine, by
// outlines and colour in the others, and zero in those that nothing determines.

#include <optional>
#include <vector>

#include "mapper/core/registration/depth_edges.hpp"
#include "mapper/core/registration/edge_alignment.hpp"
#include "mapper/core/registration/icp.hpp"
#include "mapper/core/registration/model.hpp"
#include "mapper/core/registration/observability.hpp"
#include "mapper/core/registration/photometric.hpp"
#include "mapper/core/registration/photometric_pyramid.hpp"

namespace kintsugi::mapper {

struct Step {
  Vector6d xi = Vector6d::Zero();  ///< left increment of X_VC
  /// Directions of the left increment that nothing determines.
  TwistBasis undetermined = TwistBasis(6, 0);
  /// Information of outlines and intensities, in units of that of NormalEquations; zero where they
  /// were not used.
  Matrix6d further_information = Matrix6d::Zero();
  /// Share of the frame's pixels whose intensity was compared; 1 where intensities were not used.
  double compared_share = 1.0;
  /// Smallest reliability (see observability.hpp) of the directions that colour determines; 1 where
  /// there are none.
  double photometric_reliability = 1.0;
};

/// Computes the steps of one registration of a frame with a model (V) and, by colour, with a
/// reference frame (K).
///
/// With V_o a basis of the directions that the surfaces determine and V_d one of the rest, the
/// increment is x = V_o y_o + V_d y_d:
///   (V_o' A V_o) y_o = V_o' b                       of the point-to-plane system A, b alone,
///   (V_d' H V_d) y_d = V_d' (g - H V_o y_o)
/// where H, g is the sum of the systems of the outlines, of the intensities and, as far as it is
/// not noise, of the surfaces. y_d is zero in the directions of V_d that this sum does not
/// determine: there the predicted pose stays. Where the surfaces determine all directions, nothing
/// else is used.
class StepSolver {
 public:
  struct Config {
    ObservabilityConfig observability;
    EdgeAlignmentConfig edges;
    PhotometricConfig photometric;
  };

  /// `frame_C`, `model` and the frames with colour to which `colors` refers outlive the solver.
  StepSolver(const SurfacePyramid& frame_C, const Model& model, const PhotometricPair& colors,
             const Config& config)
      : frame_C_(frame_C),
        model_(model),
        colors_(colors),
        config_(config),
        edges_(frame_C.size()) {}

  /// Decides which directions the surfaces determine in the following steps.
  void observe(const Information& geometric);

  /// The increment of X_VC at a level of the pyramids; nothing if the equations have no solution.
  std::optional<Step> solve(const NormalEquations& geometric, int level, const Pose& X_VC);

  /// Directions of the left increment of X_VC that the surfaces do not determine.
  const TwistBasis& open_to_depth() const { return geometry_.open; }

 private:
  /// A system that determines directions which the surfaces leave open.
  struct FurtherEquations {
    Information information;  ///< of independent measurements, see independent()
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
  };
  struct EdgesOfLevel {
    DepthEdges frame_C;
    DepthEdges model_V;
  };

  void add_open_part(const NormalEquations& geometric, int level, const Pose& X_VC, Step& step);
  /// Which certainty is enough for directions that depth alone does not determine: see
  /// sufficient_priors, or a deviation like the typical noise of the inliers' depths, which the map
  /// averages over many frames.
  ObservabilityConfig sufficient(const NormalEquations& geometric) const;
  void add_edges(int level, const Pose& X_VC, FurtherEquations& sum);
  void add_intensities(int level, const Pose& X_VC, FurtherEquations& sum, Step& step);

  const SurfacePyramid& frame_C_;
  const Model& model_;
  PhotometricPair colors_;
  Config config_;
  ObservableSplit geometry_;
  PureInformation pure_;                            ///< of the surfaces in geometry_.open
  std::vector<std::optional<EdgesOfLevel>> edges_;  ///< of the levels that needed them
  std::optional<Exposure> exposure_;                ///< as of the step before
};

}  // namespace kintsugi::mapper
