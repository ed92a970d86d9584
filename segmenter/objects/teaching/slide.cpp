#include "segmenter/objects/teaching/slide.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/recognition/lit_model.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

/// Of each observation about so many points are asked: one of a hundred of them is a hundredth.
constexpr std::size_t kAsked = 1000;
/// In half spacings. Closest points were seen to lead three spacings astray, and no more.
constexpr int kFarthest = 8;

/// One observation, in which the points of the other are looked for.
class Observation {
 public:
  /// Colours are not averaged over more than a point: at an edge they would be mixed with those of
  /// a side that only one of the observations has.
  Observation(std::span<const CloudPoint> points, float spacing_m)
      : points_(points), surface_(unthinned(points, 0.1F * spacing_m)), nearest_(points) {}

  /// The indices of points that stand for all, evenly over the list.
  [[nodiscard]] std::vector<std::size_t> asked() const {
    const std::size_t step = std::max<std::size_t>(1, points_.size() / kAsked);
    std::vector<std::size_t> indices;
    indices.reserve(points_.size() / step + 1);
    for (std::size_t i = 0; i < points_.size(); i += step) indices.push_back(i);
    return indices;
  }

  /// How many of the points that `other` asks for are here, when its frame is at X_AB.
  [[nodiscard]] std::int64_t count(const Observation& other, const Pose& X_AB,
                                   const LightChange& light, float reach_m) const {
    const std::vector<std::size_t> asked = other.asked();
    std::vector<CloudPoint> queries;
    queries.reserve(asked.size());
    for (const std::size_t i : asked) queries.push_back(transformed(other.points_[i], X_AB));
    NearestNeighbours::Result found;
    nearest_.find(queries, 1, found);
    LitModel lit(surface_, light);
    std::int64_t num_same = 0;
    for (std::size_t k = 0; k < queries.size(); ++k) {
      if (found.squared_distances[k] > reach_m * reach_m) continue;
      const SurfacePoint& here = surface_[found.indices[k]];
      const Eigen::Vector3f normal(queries[k].nx, queries[k].ny, queries[k].nz);
      if (here.normal.dot(normal) < kSameNormal) continue;
      if (lit.same_color(found.indices[k], other.surface_[asked[k]])) ++num_same;
    }
    return num_same;
  }

 private:
  std::span<const CloudPoint> points_;
  Surface surface_;  ///< the same points
  NearestNeighbours nearest_;
};

struct Slide {
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  std::int64_t num_same = 0;
};

}  // namespace

Pose slid(std::span<const CloudPoint> known_O, std::span<const CloudPoint> lesson_L,
          const Pose& X_OL, const LightChange& light, float spacing_m) {
  const Observation known(known_O, spacing_m);
  const Observation lesson(lesson_L, spacing_m);
  LightChange back;
  back.log_gain = -light.log_gain;
  const auto num_same = [&](const Pose& X) {
    return known.count(lesson, X, light, spacing_m) +
           lesson.count(known, X.inverse(), back, spacing_m);
  };
  std::vector<Slide> slides;
  std::int64_t most = 0;
  for (int i = -kFarthest; i <= kFarthest; ++i) {
    for (int j = -kFarthest; j <= kFarthest; ++j) {
      const Eigen::Vector3d offset_m = 0.5 * spacing_m * Eigen::Vector3d(i, j, 0);
      const Pose X_slid(Eigen::Translation3d(offset_m) * X_OL);
      slides.push_back({offset_m, num_same(X_slid)});
      most = std::max(most, slides.back().num_same);
    }
  }
  if (100 * num_same(X_OL) >= 99 * most) return X_OL;
  std::erase_if(slides, [&](const Slide& slide) { return 100 * slide.num_same < 99 * most; });
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (const Slide& slide : slides) sum_m += slide.offset_m;
  return Pose(Eigen::Translation3d(sum_m / static_cast<double>(slides.size())) * X_OL);
}

}  // namespace kintsugi::segmenter
