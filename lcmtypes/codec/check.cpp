#include "lcmtypes/codec/check.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi {
namespace codec {
namespace {

// A rotation normalised in double precision is orthonormal to 1e-15. An error of 1e-6 moves a point
// at 10 m by a hundredth of a millimetre.
constexpr double kRotationTolerance = 1e-6;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

void Check::records_version(std::int16_t version, std::int16_t known) const {
  if (version == known) return;
  std::ostringstream text;
  text << type_ << " has records of version " << version << ", this program knows version " << known
       << ": it was sent or recorded by another version of Kintsugi";
  throw std::invalid_argument(text.str());
}

void Check::finite(const char* field, double value) const {
  if (!std::isfinite(value)) fail(field, value, "a finite number");
}

void Check::position(const char* field, double value) const {
  range(field, value, -kMaxPosition_m, kMaxPosition_m);
}

void Check::text(const char* field, const std::string& value) const {
  if (value.size() > kMaxStringBytes) {
    fail(field, std::to_string(value.size()) + " bytes long",
         "at most " + std::to_string(kMaxStringBytes));
  }
  const auto bad = std::find_if(value.begin(), value.end(), is_control);
  if (bad != value.end()) {
    fail(field, "a text with byte " + std::to_string(static_cast<unsigned char>(*bad)),
         "no control characters");
  }
}

void Check::pose(const char* field, const Pose& value) const {
  const Eigen::Vector3d t = value.translation();
  for (const double coordinate : t) position(field, coordinate);
  const Eigen::Matrix3d R = value.linear();
  const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  // Written so that NaN fails.
  if (!(error <= kRotationTolerance)) fail(field, error, "a rotation with R^T R = I within 1e-6");
  if (!(R.determinant() > 0.0)) fail(field, R.determinant(), "a rotation, determinant 1");
}

void pose_to_wire(const Pose& X, double (&rows)[12]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows[4 * row + column] = X.matrix()(row, column);
  }
}

Pose pose_from_wire(const double (&rows)[12]) {
  Pose X = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) X.matrix()(row, column) = rows[4 * row + column];
  }
  return X;
}

}  // namespace codec

std::string fitting_text(std::string text) {
  if (text.size() > kMaxStringBytes) text.resize(kMaxStringBytes);
  std::replace_if(text.begin(), text.end(), codec::is_control, ' ');
  return text;
}

}  // namespace kintsugi
