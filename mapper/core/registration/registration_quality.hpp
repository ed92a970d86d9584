#pragma once

namespace kintsugi::mapper {

/// What a registration measures about its own result; LossRule judges it.
///
/// Overlap is the evidence: the pixels whose point projects onto a surface of the model. Parts of
/// the view that are seen for the first time count neither for nor against a pose.
struct RegistrationQuality {
  double covered_share = 0.0;   ///< pixels whose point lies in Model::region_W / all pixels
  double overlap_share = 0.0;   ///< pixels that project onto a surface of the model / all pixels
  double inlier_share = 0.0;    ///< pairs that passed the gates / overlap
  double behind_share = 0.0;    ///< points clearly behind the model's surface / overlap; the camera
                                ///< cannot see through a surface, so many mean a wrong pose
  double in_front_share = 0.0;  ///< points clearly in front of it / overlap; may be a new object
  double rms_m = 0.0;           ///< of the point-to-plane residuals of the inliers
  double rms_sigmas = 0.0;      ///< the same, each in units of the noise of its depth
  double sigma_m = 0.0;         ///< uncertainty of the pose, see pose_sigma_m()
  double voxel_m = 0.0;         ///< side of the model's voxels
  double noise_m = 0.0;         ///< typical noise of the inliers' depths
  bool solved = false;          ///< the normal equations had a solution at every step
  int undetermined = 0;         ///< directions of motion that neither depth nor colour determines

  double outlier_share() const { return 1.0 - inlier_share; }  ///< of the overlap

  /// Pairs that agree less those that do not, as a share of all pixels: of two poses of a frame
  /// the one that is supported more fits better. Pixels without overlap have no voice.
  double support() const { return overlap_share * (inlier_share - outlier_share()); }
};

}  // namespace kintsugi::mapper
