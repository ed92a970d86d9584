#include "mapper/core/registration/observability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/registration/pose_uncertainty.hpp"
#include "mapper/core/registration/row_bands.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kNoPrior = 1e6;  ///< metres or radians: nothing is known beforehand

/// Pairs each pixel of a frame with the model pixel onto which it projects.
class NormalPairs {
 public:
  NormalPairs(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
              const IcpGates& gates)
      : frame_(frame_C),
        model_(model_V),
        model_camera_(pinhole_camera(model_V.intrinsics)),
        R_VC_(X_VC.linear().cast<float>()),
        p_VC_(X_VC.translation().cast<float>()),
        max_squared_distance_(static_cast<float>(gates.max_distance_m * gates.max_distance_m)),
        squared_sigmas_(static_cast<float>(gates.max_distance_sigmas * gates.max_distance_sigmas)),
        min_cosine_(static_cast<float>(gates.min_normal_cosine)) {}

  InformationSum sum_rows(int first, int last) const {
    InformationSum sum;
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < frame_.depth_m.cols; ++u) add_pixel(v, u, sum);
    }
    return sum;
  }

 private:
  void add_pixel(int v, int u, InformationSum& sum) const {
    if (std::isnan(frame_.normal_z(v, u))) return;
    const Eigen::Vector3f p = R_VC_ * frame_.point(v, u) + p_VC_;
    const float x = model_camera_.fx * p.x() / p.z() + model_camera_.cx + 0.5F;
    const float y = model_camera_.fy * p.y() / p.z() + model_camera_.cy + 0.5F;
    // Negated so that a NaN on either side returns.
    if (!(p.z() > 0.0F && x >= 0.0F && y >= 0.0F)) return;
    if (!(x < model_.depth_m.cols && y < model_.depth_m.rows)) return;
    const int col = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const Eigen::Vector3f model_normal = model_.normal(row, col);
    const Eigen::Vector3f frame_normal = R_VC_ * frame_.normal(v, u);
    const auto variance_m2 = static_cast<float>(frame_.noise.variance_m2(frame_.depth_m(v, u)));
    const float max_squared = max_squared_distance_ + squared_sigmas_ * variance_m2;
    if (!((model_.point(row, col) - p).squaredNorm() < max_squared)) return;
    if (!(frame_normal.dot(model_normal) > min_cosine_)) return;
    sum.add(increment_row(model_normal, p), increment_row(frame_normal, p), 1.0F / variance_m2);
  }

  const SurfaceMap& frame_;
  const SurfaceMap& model_;
  PinholeCamera model_camera_;
  Eigen::Matrix3f R_VC_;
  Eigen::Vector3f p_VC_;
  float max_squared_distance_;
  float squared_sigmas_;
  float min_cosine_;
};

}  // namespace

void ObservabilityConfig::validate() const {
  check_range("min_reliability", min_reliability, 1e-3, 1.0);
  check_range("prior_m", prior_m, 1e-6, 1e3);
  check_range("prior_rad", prior_rad, 1e-6, 1e3);
  check_range("sufficient_priors", sufficient_priors, 0.0, 1e3);
  check_range("min_purity", min_purity, 1e-3, 1.0);
}

Information independent(const Information& information, std::size_t num_pixels) {
  const double share = kIndependentPatches / static_cast<double>(num_pixels);
  return {share * information.A, share * information.C};
}

ObservableSplit split_observable(const Information& information, const TwistBasis& space,
                                 const ObservabilityConfig& config) {
  ObservableSplit split;
  split.determined.resize(6, 0);
  if (space.cols() == 0) return split;
  Vector6d prior;
  prior.head<3>().setConstant(1.0 / (config.prior_m * config.prior_m));
  prior.tail<3>().setConstant(1.0 / (config.prior_rad * config.prior_rad));
  Matrix6d total = information.A;
  total.diagonal() += prior;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      space.transpose() * information.C * space, space.transpose() * total * space);
  const Eigen::VectorXd& reliability = solver.eigenvalues();  // ascending
  const Eigen::Index num_open = (reliability.array() < config.min_reliability).count();
  split.open = space * solver.eigenvectors().leftCols(num_open);
  split.determined = space * solver.eigenvectors().rightCols(space.cols() - num_open);
  split.least_reliability = reliability(0);
  if (num_open < space.cols()) split.least_determined = reliability(num_open);
  return split;
}

PureInformation pure_information(const Information& information, const TwistBasis& space,
                                 const ObservabilityConfig& config) {
  PureInformation pure;
  if (space.cols() == 0) return pure;
  ObservabilityConfig no_prior = config;
  no_prior.prior_m = no_prior.prior_rad = kNoPrior;
  no_prior.min_reliability = config.min_purity;
  const ObservableSplit split = split_observable(information, space, no_prior);
  if (split.determined.cols() == 0) return pure;
  // The columns of B are scaled to B' A B = 1, and B' C B is diagonal.
  TwistBasis B(6, space.cols());
  B << split.determined, split.open;
  Eigen::VectorXd share = Eigen::VectorXd::Zero(B.cols());
  for (Eigen::Index i = 0; i < split.determined.cols(); ++i) {
    share(i) = std::min(1.0, B.col(i).dot(information.C * B.col(i)));
  }
  const Eigen::MatrixXd inverse = B.completeOrthogonalDecomposition().pseudoInverse();
  pure.information = inverse.transpose() * share.asDiagonal() * inverse;
  pure.weighting = B * share.cwiseSqrt().asDiagonal() * inverse;
  return pure;
}

Information geometric_information(const SurfaceMap& frame_C, const SurfaceMap& model_V,
                                  const Pose& X_VC, const IcpGates& gates) {
  const NormalPairs pairs(frame_C, model_V, X_VC, gates);
  Information information;
  for (const InformationSum& band : sum_bands<InformationSum>(
           frame_C.depth_m.size(),
           [&](int first, int last) { return pairs.sum_rows(first, last); })) {
    band.add_to(information);
  }
  return information;
}

}  // namespace kintsugi::mapper
