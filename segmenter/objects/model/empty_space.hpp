#pragma once
// Where an object has no surface, as far as that was seen.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// A grid around an object, of cells through all of which cameras saw when it was taught. What is
/// not empty holds the object, or something else, or was hidden: nothing is known of it.
class EmptySpace {
 public:
  static constexpr int kMostCells = 16;  ///< along an axis: half a kilobyte in all

  /// Nothing is known.
  EmptySpace() = default;
  /// @param is_empty of each cell, x first
  /// @throws std::invalid_argument unless there are 1 to kMostCells cells along each axis, as many
  ///   values as cells, and cell_m > 0
  EmptySpace(const Eigen::Vector3f& low_O, float cell_m, const Eigen::Vector3i& size,
             std::vector<bool> is_empty);

  /// No cell was seen to be empty.
  [[nodiscard]] bool is_unknown() const { return is_unknown_; }
  /// Whether the place is in an empty cell.
  [[nodiscard]] bool contains(const Eigen::Vector3f& p_O) const;

  [[nodiscard]] const Eigen::Vector3f& low_O() const { return low_O_; }
  [[nodiscard]] float cell_m() const { return cell_m_; }
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] const std::vector<bool>& is_empty() const { return is_empty_; }

  bool operator==(const EmptySpace&) const = default;

 private:
  Eigen::Vector3f low_O_ = Eigen::Vector3f::Zero();
  float cell_m_ = 0.0F;
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<bool> is_empty_;
  bool is_unknown_ = true;
};

/// What the cameras saw around an object that stands at X_WO. Without views nothing is known.
EmptySpace empty_space(std::span<const CloudPoint> points_O, const Pose& X_WO,
                       const ObservedSpace& observed);

/// Of an object that was taught twice: what one of both knows to be empty is empty.
/// @param points_O of both together
/// @param X_OL of the frame in which `lesson` is
EmptySpace merged(std::span<const CloudPoint> points_O, const EmptySpace& known,
                  const EmptySpace& lesson, const Pose& X_OL);

}  // namespace kintsugi::segmenter
