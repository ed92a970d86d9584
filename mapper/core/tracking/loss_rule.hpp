#pragma once
// When is a registration not to be believed?

#include <optional>
#include <string>
#include <string_view>

namespace kintsugi::mapper {

/// What a registration reports about itself.
///
/// Overlap is the evidence: the pixels whose point falls on a surface that the model shows. What is
/// seen for the first time says nothing for a pose and nothing against it.
struct RegistrationQuality {
  double covered_share = 0.0;   ///< frame pixels whose point lies where the map can be / all pixels
  double overlap_share = 0.0;   ///< pixels that fall on a surface of the model / all pixels
  double inlier_share = 0.0;    ///< pairs that passed the gates / overlap
  double behind_share = 0.0;    ///< points clearly behind the model's surface / overlap: it was
                                ///< looked through a known surface, so the pose is wrong
  double in_front_share = 0.0;  ///< points clearly in front of it / overlap: perhaps something new
  double rms_m = 0.0;           ///< of the point-to-plane residuals of the inliers
  double sigma_m = 0.0;         ///< how well the pose is determined, see pose_sigma_m()
  bool solved = false;          ///< the normal equations had a solution at every step
  int undetermined = 0;         ///< directions of motion that neither depth nor colour determines
};

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
  kUndetermined
};

std::string_view to_string(LossReason reason);

/// What a registration must show at least. Measured on right and wrong poses: bench_loss_evidence.
struct Evidence {
  double min_overlap_share = 0.0;   ///< of all pixels
  double min_inlier_share = 0.0;    ///< of the overlap
  double max_behind_share = 1.0;    ///< of the overlap
  double max_in_front_share = 1.0;  ///< of the overlap
  double max_rms_m = 1.0;
  double max_sigma_m = 1.0;

  /// @throws std::invalid_argument naming `name`.field, value and bound
  void validate(const std::string& name) const;
};

/// What of the evidence is missing; nothing if it is all there.
std::optional<LossReason> find_fault(const RegistrationQuality& quality, const Evidence& needed);

/// Judges frames one after another. It remembers how much of the view was covered.
///
/// A pose that continues the camera's motion has that motion in its favour; one that was found anew
/// (after a loss, by a wide search, far from where the camera was expected) has only the picture,
/// and similar places look alike: it must fit much better.
class LossRule {
 public:
  struct Config {
    double min_covered_share = 0.02;  ///< of all pixels
    double max_covered_drop = 0.4;    ///< may fall by this much of the recent one
    double recent_view_decay = 0.9;   ///< per frame: a view that stays small is accepted
    Evidence following{.min_overlap_share = 0.02,
                       .min_inlier_share = 0.3,
                       .max_behind_share = 0.2,
                       .max_in_front_share = 0.4,
                       .max_rms_m = 0.014,
                       .max_sigma_m = 0.02};
    Evidence found_anew{.min_overlap_share = 0.25,
                        .min_inlier_share = 0.4,
                        .max_behind_share = 0.08,
                        .max_in_front_share = 0.15,
                        .max_rms_m = 0.012,
                        .max_sigma_m = 0.01};
    int grace_frames = 10;  ///< believed frames before min_inlier_share applies: the model is thin

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit LossRule(const Config& config);

  /// Why this registration, which follows the camera's motion, is not believed; nothing if it is.
  std::optional<LossReason> judge(const RegistrationQuality& quality) const;

  /// Why this registration, found without knowing where the camera was, is not believed.
  std::optional<LossReason> judge_found_anew(const RegistrationQuality& quality) const;

  /// To be called once for each frame, after judging it.
  void remember(double covered_share, bool believed);

 private:
  bool is_cut_off(const RegistrationQuality& quality) const;

  Config config_;
  double recent_covered_share_ = 0.0;
  int believed_frames_ = 0;
};

}  // namespace kintsugi::mapper
