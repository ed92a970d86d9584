#include "segmenter/core/points/admission.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::segmenter {

std::optional<std::string_view> reason_to_reject_position(const CloudPoint& point) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) {
    return "its position is not finite";
  }
  if (std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > kMaxCoordinate_m) {
    return "its position is more than 1000 km from the origin";
  }
  return std::nullopt;
}

std::optional<std::string_view> reason_to_reject(const CloudPoint& point) {
  if (const auto reason = reason_to_reject_position(point)) {
    return reason;
  }
  const double nx = point.nx, ny = point.ny, nz = point.nz;
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (!std::isfinite(length)) {
    return "its normal is not finite";
  }
  if (std::abs(length - 1.0) > kNormalLengthTolerance) {
    return "its normal is not of unit length";
  }
  return std::nullopt;
}

}  // namespace kintsugi::segmenter
