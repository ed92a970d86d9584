#pragma once
// Where the camera has seen that there is nothing, where it measured surface, and where it never
// looked.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/views/map_view.hpp"

namespace kintsugi::segmenter {

/// How the views saw a place. A view that has no depth there, or at whose depth edge it is, says
/// nothing.
struct Sights {
  int through = 0;   ///< views that measured something behind it: it was free
  int measured = 0;  ///< views that measured surface there, within their noise

  bool operator==(const Sights&) const = default;
};

/// The same of a place of a surface.
struct SightsOfSurface {
  Sights sights;
  bool is_covered = false;  ///< a view from its side measured something close in front of it
};

class ObservedSpace {
 public:
  /// @param resolution_m how exact the map is: its voxel size, or its error if that is more; > 0
  explicit ObservedSpace(double resolution_m) : resolution_m_(resolution_m) {}

  /// @throws std::invalid_argument when the depth image has not the size that its intrinsics tell
  void add(MapView view);
  void clear();
  [[nodiscard]] bool empty() const { return views_.empty(); }
  [[nodiscard]] const std::vector<MapView>& views() const { return views_; }

  /// What the views tell about a place. Conservative: it counts as seen through only where the
  /// measurements around it, as far as the resolution and at least a pixel to each side, are all
  /// behind it by more than the resolution and three standard deviations of the camera's depth
  /// there.
  [[nodiscard]] Sights sights(const Eigen::Vector3f& p_W) const;

  /// The views that may show something of a sphere, or what is less than `within_m` in front of a
  /// place in it, by their number: all that matter to a place in it.
  [[nodiscard]] std::vector<std::size_t> views_of(const Eigen::Vector3f& center_W, float radius_m,
                                                  float within_m = 0.0F) const;
  /// What some of the views tell about a place.
  [[nodiscard]] Sights sights(const Eigen::Vector3f& p_W, std::span<const std::size_t> views) const;

  /// The same of a surface there. It is covered if one of the views that look at it from its side
  /// (at more than `grazing`, the sine of an angle) measured something in front of it that is
  /// nearer to it than `within_m`.
  [[nodiscard]] SightsOfSurface sights(const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                                       float grazing, float within_m,
                                       std::span<const std::size_t> views) const;

  /// The same of many places, on all cores: places that are near each other share the search for
  /// the views that may show them.
  [[nodiscard]] std::vector<Sights> sights(std::span<const Eigen::Vector3f> points_W) const;

 private:
  struct Cone {  // a view sees nothing outside of it
    Eigen::Vector3f apex_W;
    Eigen::Vector3f axis_W;
    float cosine = 0.0F;  // of its half angle
    float sine = 0.0F;

    [[nodiscard]] bool meets(const Eigen::Vector3f& center_W, float radius_m) const;
  };

  enum class Sight : std::uint8_t { kNothing, kThrough, kMeasured, kHidden };
  struct Look {
    Sight sight = Sight::kNothing;
    float behind_m = 0.0F;  // of what is hidden: behind what was measured, along the ray
  };

  [[nodiscard]] double margin_m(double z_m) const;
  [[nodiscard]] bool may_show(std::size_t view, const Eigen::Vector3f& center_W, float radius_m,
                              float within_m) const;
  [[nodiscard]] Look look(std::size_t view, const Eigen::Vector3f& p_W) const;
  static void count(const Look& look, Sights& sights);

  double resolution_m_;
  std::vector<MapView> views_;
  std::vector<Eigen::Matrix<float, 3, 4>> X_CW_;  // of each view
  std::vector<Cone> cones_;                       // of each view
  std::vector<float> farthest_m_;                 // of each view, the largest depth
};

}  // namespace kintsugi::segmenter
