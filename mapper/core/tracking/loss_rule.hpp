#pragma once
// When a registration is rejected and the camera counts as lost.

#include <optional>
#include <string>
#include <string_view>

#include "mapper/core/registration/registration_quality.hpp"

namespace kintsugi::mapper {

enum class LossReason {
  kTooFewPixels,
  kViewCutOff,
  kNotSolved,
  kTooLittleOverlap,
  kTooFewInliers,
  kThroughSurface,
  kBeforeSurface,
  kLargeResidual,
  kUncertain,
  kUndetermined,
  kMuchWorseThanUsual
};

std::string_view to_string(LossReason reason);

/// The quality that a registration must have to be accepted. The values come from measurements on
/// right and wrong poses: bench_loss_evidence.
struct Evidence {
  double min_overlap_share = 0.0;   ///< of all pixels
  double min_inlier_share = 0.0;    ///< of the overlap
  double max_behind_share = 1.0;    ///< of the overlap
  double max_in_front_share = 1.0;  ///< of the overlap
  /// Larger residuals are a fault only if both are exceeded: near the camera the voxels, farther
  /// away the noise of the depth limits how well a right pose fits.
  double max_rms_vox = 100.0;
  double max_rms_sigmas = 100.0;
  /// Likewise for the uncertainty of the pose.
  double max_sigma_vox = 100.0;
  double max_sigma_noises = 100.0;  ///< in units of the noise of the depths

  /// @throws std::invalid_argument naming `name`.field, value and bound
  void validate(const std::string& name) const;
};

/// The first requirement that the registration does not meet; nothing if it meets all.
std::optional<LossReason> find_fault(const RegistrationQuality& quality, const Evidence& needed);

/// Judges frames one after another; it remembers how much of the recent views was covered.
///
/// A pose that continues the camera's motion is supported by that motion. A pose that was found
/// anew (after a loss, by a wide search, or far from the predicted pose) rests on this frame alone,
/// and different places may look alike: it must fit much better.
class LossRule {
 public:
  struct Config {
    double min_covered_share = 0.02;  ///< of all pixels
    double max_covered_drop = 0.4;    ///< largest drop, as a share of the recent covered share
    double recent_view_decay = 0.9;  ///< of the recent share, per frame: a view that stays small is
                                     ///< accepted after a while
    Evidence following{.min_overlap_share = 0.02,
                       .min_inlier_share = 0.3,
                       .max_behind_share = 0.2,
                       .max_in_front_share = 0.4,
                       .max_rms_vox = 1.6,
                       .max_rms_sigmas = 2.2,
                       .max_sigma_vox = 2.3,
                       .max_sigma_noises = 1.0};
    Evidence found_anew{.min_overlap_share = 0.25,
                        .min_inlier_share = 0.4,
                        .max_behind_share = 0.08,
                        .max_in_front_share = 0.15,
                        .max_rms_vox = 1.4,
                        .max_rms_sigmas = 2.0,
                        .max_sigma_vox = 1.15,
                        .max_sigma_noises = 0.5};
    double usual_decay = 0.98;     ///< of what the usual shares were, per accepted frame
    double max_usual_share = 0.2;  ///< the usual shares count up to this
    double unusual_factor = 1.5;   ///< on the usual outliers and residuals: more is unusual
    /// Likewise: where both are larger than this, a pose found anew is rejected.
    double much_worse_factor = 2.0;
    int grace_frames = 10;  ///< accepted frames before min_inlier_share applies, because the model
                            ///< is noisy at the start

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit LossRule(const Config& config);

  /// Why this registration, which continues the camera's motion, is rejected; nothing if it is
  /// accepted.
  std::optional<LossReason> judge(const RegistrationQuality& quality) const;

  /// Why this registration, found anew, is rejected; nothing if it is accepted.
  std::optional<LossReason> judge_found_anew(const RegistrationQuality& quality) const;

  /// Whether so many more pairs than usual are outliers, or residuals are so much larger, that
  /// another pose may fit better. Without an accepted frame nothing is usual yet.
  bool fits_worse_than_usual(const RegistrationQuality& quality) const;

  /// To be called once for each frame, after it was judged. A frame that was not registered,
  /// because its pose was given, has no overlap.
  void remember(const RegistrationQuality& quality, bool accepted);

 private:
  bool is_cut_off(const RegistrationQuality& quality) const;
  bool fits_much_worse_than_usual(const RegistrationQuality& quality) const;
  /// Some cameras often measure a depth that is grossly wrong, even if the pose is right: the
  /// shares of points behind and in front of surfaces may exceed the limits by what is usual.
  Evidence allow_usual(Evidence needed) const;

  struct Fit {
    double outlier_share;
    double rms_sigmas;
  };

  Config config_;
  double recent_covered_share_ = 0.0;
  double usual_behind_share_ = 0.0;  ///< of the accepted frames
  double usual_in_front_share_ = 0.0;
  std::optional<Fit> usual_fit_;  ///< likewise; none before the first of them
  int accepted_frames_ = 0;
};

}  // namespace kintsugi::mapper
