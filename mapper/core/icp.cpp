#include "mapper/core/icp.hpp"

#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

namespace kintsugi::mapper {
namespace {

constexpr int kRowsPerBand = 8;

/// What one band of rows contributes; the upper triangle of [A b; . E], row by row.
struct BandSum {
  double system[28] = {};
  double squared_residuals_m2 = 0.0;
  std::int64_t inliers = 0;
  SurfaceAgreement agreement;

  /// Adds a row of the Jacobian with its residual in the last place.
  void add(const double (&row)[7], double weight) {
    int k = 0;
    for (int i = 0; i < 7; ++i) {
      const double weighted = weight * row[i];
      for (int j = i; j < 7; ++j) system[k++] += weighted * row[j];
    }
    squared_residuals_m2 += row[6] * row[6];
    ++inliers;
  }
};

class Linearizer {
 public:
  Linearizer(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
             const IcpGates& gates)
      : frame_(frame_C),
        model_(model_V),
        R_VC_(X_VC.linear().cast<float>()),
        p_VC_(X_VC.translation().cast<float>()),
        max_squared_distance_(static_cast<float>(gates.max_distance_m * gates.max_distance_m)),
        min_cosine_(static_cast<float>(gates.min_normal_cosine)),
        fx_(static_cast<float>(model_V.intrinsics.fx)),
        fy_(static_cast<float>(model_V.intrinsics.fy)),
        cx_(static_cast<float>(model_V.intrinsics.cx)),
        cy_(static_cast<float>(model_V.intrinsics.cy)) {}

  BandSum sum_rows(int first, int last) const {
    BandSum sum;
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < frame_.depth_m.cols; ++u) add_pixel(v, u, sum);
    }
    return sum;
  }

 private:
  void add_pixel(int v, int u, BandSum& sum) const {
    const float depth_m = frame_.depth_m(v, u);
    if (std::isnan(depth_m)) return;
    const Eigen::Vector3f p = R_VC_ * frame_.point(v, u) + p_VC_;
    if (!(p.z() > 0.0F)) return;
    const float model_u = fx_ * p.x() / p.z() + cx_ + 0.5F;
    const float model_v = fy_ * p.y() / p.z() + cy_ + 0.5F;
    if (!(model_u >= 0.0F && model_v >= 0.0F && model_u < model_.depth_m.cols &&
          model_v < model_.depth_m.rows)) {
      return;
    }
    const int row = static_cast<int>(model_v);
    const int col = static_cast<int>(model_u);
    const double sigma_m = depth_sigma_m(depth_m);
    compare_depths(p.z(), model_.depth_m(row, col), sigma_m, sum.agreement);

    const Eigen::Vector3f n = model_.normal(row, col);
    const Eigen::Vector3f difference = model_.point(row, col) - p;
    // Written so that a NaN on either side fails them.
    if (!(difference.squaredNorm() < max_squared_distance_)) return;
    if (!((R_VC_ * frame_.normal(v, u)).dot(n) > min_cosine_)) return;

    // d(se3_retract(xi) p)/dxi = [I, -[p]x], so the prediction n . p changes by n for the
    // translation and by p x n for the rotation.
    const Eigen::Vector3d p_d = p.cast<double>();
    const Eigen::Vector3d n_d = n.cast<double>();
    const Eigen::Vector3d moment = p_d.cross(n_d);
    const double residual_m = n_d.dot(difference.cast<double>());
    sum.add({n_d.x(), n_d.y(), n_d.z(), moment.x(), moment.y(), moment.z(), residual_m},
            1.0 / (sigma_m * sigma_m));
  }

  static void compare_depths(double z_m, double model_z_m, double sigma_m,
                             SurfaceAgreement& agreement) {
    if (std::isnan(model_z_m)) return;
    const double tolerance_m =
        std::max(SurfaceAgreement::kSigmas * sigma_m, SurfaceAgreement::kDistance_m);
    ++agreement.overlap;
    if (z_m > model_z_m + tolerance_m) ++agreement.behind;
    if (z_m < model_z_m - tolerance_m) ++agreement.in_front;
  }

  const SurfaceMap& frame_;
  const SurfaceMap& model_;
  Eigen::Matrix3f R_VC_;
  Eigen::Vector3f p_VC_;
  float max_squared_distance_;
  float min_cosine_;
  float fx_, fy_, cx_, cy_;
};

NormalEquations unpack(const BandSum& sum) {
  NormalEquations equations;
  int k = 0;
  for (int i = 0; i < 7; ++i) {
    for (int j = i; j < 7; ++j, ++k) {
      if (j < 6) {
        equations.A(i, j) = equations.A(j, i) = sum.system[k];
      } else if (i < 6) {
        equations.b(i) = sum.system[k];
      } else {
        equations.weighted_squares = sum.system[k];
      }
    }
  }
  equations.squared_residuals_m2 = sum.squared_residuals_m2;
  equations.inliers = sum.inliers;
  equations.agreement = sum.agreement;
  return equations;
}

}  // namespace

Pose se3_retract(const Vector6d& xi) {
  Pose X = Pose::Identity();
  X.translation() = xi.head<3>();
  const double angle_rad = xi.tail<3>().norm();
  if (angle_rad > 1e-12) {
    X.linear() = Eigen::AngleAxisd(angle_rad, xi.tail<3>() / angle_rad).toRotationMatrix();
  }
  return X;
}

NormalEquations linearize(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
                          const IcpGates& gates) {
  const Linearizer linearizer(frame_C, model_V, X_VC, gates);
  const int rows = frame_C.depth_m.rows;
  std::vector<BandSum> bands((rows + kRowsPerBand - 1) / kRowsPerBand);
  tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t band) {
    const int first = static_cast<int>(band) * kRowsPerBand;
    bands[band] = linearizer.sum_rows(first, std::min(first + kRowsPerBand, rows));
  });
  BandSum total;
  for (const BandSum& band : bands) {  // in order: floating-point addition does not commute freely
    for (int k = 0; k < 28; ++k) total.system[k] += band.system[k];
    total.squared_residuals_m2 += band.squared_residuals_m2;
    total.inliers += band.inliers;
    total.agreement.overlap += band.agreement.overlap;
    total.agreement.behind += band.agreement.behind;
    total.agreement.in_front += band.agreement.in_front;
  }
  return unpack(total);
}

}  // namespace kintsugi::mapper
