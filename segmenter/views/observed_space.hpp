#pragma once
// Where the camera has seen that there is nothing, where it measured surface, and where it never
// looked.

#include <Eigen/Core>
#include <vector>

#include "segmenter/views/map_view.hpp"

namespace kintsugi::segmenter {

/// How the views saw a place. A view that has no depth there, or at whose depth edge it is, says
/// nothing.
struct Sights {
  int through = 0;   ///< views that measured something behind it: it was free
  int measured = 0;  ///< views that measured surface there, within their noise
  int hidden = 0;    ///< views that measured something in front of it
};

class ObservedSpace {
 public:
  /// @param resolution_m voxel size of the map, > 0
  explicit ObservedSpace(double resolution_m) : resolution_m_(resolution_m) {}

  void add(MapView view);
  void clear() { views_.clear(); }
  [[nodiscard]] bool empty() const { return views_.empty(); }
  [[nodiscard]] const std::vector<MapView>& views() const { return views_; }

  /// What the views tell about a place. Conservative: it counts as seen through only where the
  /// measurements around it are all behind it by more than the camera's noise.
  [[nodiscard]] Sights sights(const Eigen::Vector3f& p_W) const;

 private:
  double resolution_m_;
  std::vector<MapView> views_;
};

}  // namespace kintsugi::segmenter
