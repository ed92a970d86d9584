#include "segmenter/evaluation/live/first_labels.hpp"

#include <algorithm>

namespace kintsugi::segmenter {

std::optional<double> FirstLabels::label_s(const Eigen::Vector3d& p_W) const {
  std::optional<double> first_s;
  const auto low = [&](int axis) { return cell_of(p_W[axis] - radius_m_, cell_m_); };
  const auto high = [&](int axis) { return cell_of(p_W[axis] + radius_m_, cell_m_); };
  const auto middle = [&](std::int64_t cell) {
    return cell_m_ * (static_cast<double>(cell) + 0.5);
  };
  for (std::int64_t i = low(0); i <= high(0); ++i) {
    for (std::int64_t j = low(1); j <= high(1); ++j) {
      for (std::int64_t k = low(2); k <= high(2); ++k) {
        const Eigen::Vector3d middle_W(middle(i), middle(j), middle(k));
        if ((middle_W - p_W).norm() > radius_m_) continue;
        const auto cell = label_s_.find(cell_key(i, j, k));
        if (cell == label_s_.end()) continue;
        first_s = std::min(first_s.value_or(cell->second), cell->second);
      }
    }
  }
  return first_s;
}

}  // namespace kintsugi::segmenter
