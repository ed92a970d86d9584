#include "segmenter/objects/changes/changed_points.hpp"

#include <cstddef>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kNeighbours = 8;  // of two surfaces that meet, some are on each
constexpr float kAlike = 0.5F;  // cosine between normals: 60 degrees
constexpr double kReach_vox = 2.0;
// Nearer than that it is the same surface whatever the normals, which are uncertain at edges.
constexpr double kTouch_vox = 1.0;
// One view may be of a moment when somebody walked by.
constexpr int kLeastThrough = 2;
constexpr int kOutnumber = 3;

std::vector<bool> found_in(std::span<const CloudPoint> points,
                           std::span<const CloudPoint> other_points, double voxel_m) {
  std::vector<std::uint8_t> found(points.size(), 0);
  const NearestNeighbours tree(other_points);
  const auto touch_m = static_cast<float>(kTouch_vox * voxel_m);
  const auto reach_m = static_cast<float>(kReach_vox * voxel_m);
  constexpr std::size_t kGrain = 2'000;
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<std::size_t>(0, points.size(), kGrain), [&](const auto& range) {
        NearestNeighbours::Result result;
        tree.find(points.subspan(range.begin(), range.size()), kNeighbours, result);
        const auto count = static_cast<std::size_t>(result.count);
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          for (std::size_t k = 0; k < count && found[i] == 0; ++k) {
            const std::size_t at = (i - range.begin()) * count + k;
            const float squared_m2 = result.squared_distances[at];
            if (squared_m2 > reach_m * reach_m) break;
            const float alike =
                normal_of(points[i]).dot(normal_of(other_points[result.indices[at]]));
            found[i] = squared_m2 <= touch_m * touch_m || alike >= kAlike ? 1 : 0;
          }
        }
      });
  return {found.begin(), found.end()};
}

}  // namespace

std::vector<PointChange> changes_of(std::span<const CloudPoint> points,
                                    std::span<const CloudPoint> other_points,
                                    const ObservedSpace& other_space, double voxel_m) {
  const std::vector<bool> found = found_in(points, other_points, voxel_m);
  std::vector<std::size_t> lost;
  std::vector<Eigen::Vector3f> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (found[i]) continue;
    lost.push_back(i);
    places.push_back(position_of(points[i]));
  }
  const std::vector<Sights> sights = other_space.sights(places);
  std::vector<PointChange> changes(points.size(), PointChange::kSame);
  for (std::size_t k = 0; k < lost.size(); ++k) {
    const bool is_free =
        sights[k].through >= kLeastThrough && sights[k].through > kOutnumber * sights[k].measured;
    changes[lost[k]] = is_free ? PointChange::kChanged : PointChange::kUnknown;
  }
  return changes;
}

}  // namespace kintsugi::segmenter
