#include "segmenter/preprocess/nearest_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <flann/flann.hpp>

namespace kintsugi::segmenter {
namespace {

std::vector<float> positions_of(std::span<const CloudPoint> points_W) {
  std::vector<float> positions_W;
  positions_W.reserve(3 * points_W.size());
  for (const CloudPoint& p : points_W) {
    positions_W.insert(positions_W.end(), {p.x, p.y, p.z});
  }
  return positions_W;
}

}  // namespace

struct NearestNeighbours::Tree {
  explicit Tree(std::span<const CloudPoint> points_W)
      : positions_W(positions_of(points_W)),
        index(flann::Matrix<float>(positions_W.data(), points_W.size(), 3),
              flann::KDTreeSingleIndexParams(kLeafSize)) {
    if (!points_W.empty()) {
      index.buildIndex();
    }
  }

  static constexpr int kLeafSize = 12;

  std::vector<float> positions_W;
  flann::KDTreeSingleIndex<flann::L2_3D<float>> index;
};

NearestNeighbours::NearestNeighbours(std::span<const CloudPoint> points_W)
    : tree_(std::make_unique<Tree>(points_W)) {}

NearestNeighbours::~NearestNeighbours() = default;

std::size_t NearestNeighbours::size() const { return tree_->positions_W.size() / 3; }

void NearestNeighbours::find(std::span<const CloudPoint> queries_W, int k, Result& result) const {
  const std::size_t count = std::min(static_cast<std::size_t>(k), size());
  result.count = static_cast<int>(count);
  result.indices.resize(count * queries_W.size());
  result.squared_distances.resize(count * queries_W.size());
  if (count == 0 || queries_W.empty()) {
    return;
  }
  std::vector<float> positions_W = positions_of(queries_W);
  std::vector<std::size_t> indices(result.indices.size());
  const flann::Matrix<float> queries(positions_W.data(), queries_W.size(), 3);
  flann::Matrix<std::size_t> found(indices.data(), queries_W.size(), count);
  flann::Matrix<float> distances(result.squared_distances.data(), queries_W.size(), count);
  tree_->index.knnSearch(queries, found, distances, count,
                         flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  std::transform(indices.begin(), indices.end(), result.indices.begin(),
                 [](std::size_t i) { return static_cast<std::uint32_t>(i); });
}

float median_spacing_m(std::span<const CloudPoint> points_W) {
  constexpr std::size_t kMaxSamples = 100'000;
  constexpr int kNeighbours = 12;
  if (points_W.size() <= kNeighbours) {
    return 0.0F;
  }
  const std::size_t stride = (points_W.size() + kMaxSamples - 1) / kMaxSamples;
  std::vector<CloudPoint> samples_W;
  for (std::size_t i = 0; i < points_W.size(); i += stride) {
    samples_W.push_back(points_W[i]);
  }
  NearestNeighbours::Result found;
  NearestNeighbours(points_W).find(samples_W, kNeighbours + 1, found);  // each finds itself

  std::vector<float> squared_radii;
  for (std::size_t i = kNeighbours; i < found.squared_distances.size(); i += kNeighbours + 1) {
    squared_radii.push_back(found.squared_distances[i]);
  }
  const auto middle = squared_radii.begin() + static_cast<std::ptrdiff_t>(squared_radii.size() / 2);
  std::nth_element(squared_radii.begin(), middle, squared_radii.end());
  // The point itself, 11 inside the disc, and half of the 12th on its rim.
  constexpr float kPointsInDisc = kNeighbours + 0.5F;
  return std::sqrt(std::numbers::pi_v<float> * *middle / kPointsInDisc);
}

}  // namespace kintsugi::segmenter
