#include "segmenter/preprocess/nearest_neighbours.hpp"

#include <algorithm>
#include <cmath>

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
  constexpr int kNeighbours = 8;
  const std::size_t stride = (points_W.size() + kMaxSamples - 1) / kMaxSamples;
  std::vector<CloudPoint> samples_W;
  for (std::size_t i = 0; i < points_W.size(); i += stride) {
    samples_W.push_back(points_W[i]);
  }
  NearestNeighbours::Result found;
  NearestNeighbours(points_W).find(samples_W, kNeighbours, found);

  std::vector<float> spacings_m;
  for (std::size_t i = 0; i < samples_W.size(); ++i) {
    const auto begin =
        found.squared_distances.begin() + static_cast<std::ptrdiff_t>(i) * found.count;
    const auto nearest = std::find_if(begin, begin + found.count, [](float d) { return d > 0.0F; });
    if (nearest != begin + found.count) {
      spacings_m.push_back(std::sqrt(*nearest));
    }
  }
  if (spacings_m.empty()) {
    return 0.0F;
  }
  const auto middle = spacings_m.begin() + static_cast<std::ptrdiff_t>(spacings_m.size() / 2);
  std::nth_element(spacings_m.begin(), middle, spacings_m.end());
  return *middle;
}

}  // namespace kintsugi::segmenter
