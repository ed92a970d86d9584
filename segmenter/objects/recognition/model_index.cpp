#include "segmenter/objects/recognition/model_index.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <ranges>
#include <tuple>
#include <utility>

#include <flann/flann.hpp>

namespace kintsugi::segmenter {

namespace {

/// The least that an element is taken to vary: between two maps, not only between two views.
ViewDescriptor least_deviation() {
  ViewDescriptor least;
  least.head<4>().setConstant(0.1F);      // of logarithms: 10 %
  least.segment<6>(4).setConstant(5.0F);  // CIELAB
  least.tail<kShapeFeatureSize>().setConstant(0.05F);
  return least;
}

/// Size, colours and shape count alike, however many elements they have.
ViewDescriptor weights() {
  ViewDescriptor weights;
  const auto weight = [](int elements) {
    return std::sqrt(static_cast<float>(kViewDescriptorSize) /
                     (3.0F * static_cast<float>(elements)));
  };
  weights.head<4>().setConstant(weight(4));
  weights.segment<6>(4).setConstant(weight(6));
  weights.tail<kShapeFeatureSize>().setConstant(weight(kShapeFeatureSize));
  return weights;
}

ViewDescriptor deviation_between_views(const std::vector<IndexedView>& views) {
  std::map<std::size_t, std::pair<ViewDescriptor, float>> sums;
  for (const IndexedView& view : views) {
    auto& [sum, count] = sums.try_emplace(view.model, ViewDescriptor::Zero(), 0.0F).first->second;
    sum += view.descriptor;
    count += 1.0F;
  }
  ViewDescriptor squares = ViewDescriptor::Zero();
  for (const IndexedView& view : views) {
    const auto& [sum, count] = sums.at(view.model);
    squares += (view.descriptor - sum / count).cwiseAbs2();
  }
  const float num_free = std::max(1.0F, static_cast<float>(views.size() - sums.size()));
  return (squares / num_free).cwiseSqrt().cwiseMax(least_deviation());
}

/// Of a distance as ModelMatch has it: the sum over the elements.
float squared(float distance) {
  return distance * distance * static_cast<float>(kViewDescriptorSize);
}

float distance_of(float squared) {
  return std::sqrt(squared / static_cast<float>(kViewDescriptorSize));
}

// Without colours the distance is a mean over two things that count alike instead of three.
constexpr float kWithoutColors = 1.5F;

/// Between descriptors that are scaled, squared. Colours count where both have some: their absolute
/// values decide before all else, and those of a map without colours say nothing.
float squared_distance(const ViewDescriptor& a, const ViewDescriptor& b) {
  const ViewDescriptor d = a - b;
  if (has_colors(a.head<kSizeAndColors>()) && has_colors(b.head<kSizeAndColors>())) {
    return d.squaredNorm();
  }
  return kWithoutColors * (d.head<4>().squaredNorm() + d.tail<kShapeFeatureSize>().squaredNorm());
}

}  // namespace

struct ModelIndex::Search {
  ViewDescriptor inverse_deviation;
  std::vector<IndexedView> views;           // scaled
  std::vector<std::size_t> without_colors;  // of these
  std::vector<float> data;                  // how their descriptors begin, one after the other
  std::unique_ptr<flann::Index<flann::L2<float>>> index;  // of `data`

  /// How far the nearest beginning is.
  [[nodiscard]] float least_squared(const SizeAndColors& scaled) const {
    float least = std::numeric_limits<float>::infinity();
    const auto compare = [&](std::size_t i) { least = std::min(least, size_squared(i, scaled)); };
    if (has_colors(scaled)) {
      least = least_squared_of_all(scaled);
      std::ranges::for_each(without_colors, compare);
    } else {
      std::ranges::for_each(std::views::iota(std::size_t{0}, views.size()), compare);
    }
    return least;
  }

  /// The views that are nowhere near farther off than `most_squared`: those whose beginnings are
  /// nearer than that, ascending.
  [[nodiscard]] std::vector<std::size_t> near(const SizeAndColors& scaled,
                                              float most_squared) const {
    std::vector<std::size_t> near;
    const auto is_near = [&](std::size_t i) { return size_squared(i, scaled) <= most_squared; };
    if (!has_colors(scaled)) {
      std::ranges::copy_if(std::views::iota(std::size_t{0}, views.size()), std::back_inserter(near),
                           is_near);
      return near;
    }
    near = near_of_all(scaled, most_squared);
    std::ranges::copy_if(without_colors, std::back_inserter(near), is_near);
    std::ranges::sort(near);
    near.erase(std::ranges::unique(near).begin(), near.end());
    return near;
  }

 private:
  /// Of the beginnings, where one of two has no colours.
  [[nodiscard]] float size_squared(std::size_t view, const SizeAndColors& scaled) const {
    const SizeAndColors beginning = views[view].descriptor.head<kSizeAndColors>();
    return kWithoutColors * (beginning - scaled).head<4>().squaredNorm();
  }

  /// Of the nearest beginning, as if all had colours.
  [[nodiscard]] float least_squared_of_all(SizeAndColors scaled) const {
    std::size_t view = 0;
    float squared = 0.0F;
    flann::Matrix<std::size_t> views_of_query(&view, 1, 1);
    flann::Matrix<float> squares_of_query(&squared, 1, 1);
    index->knnSearch(flann::Matrix<float>(scaled.data(), 1, kSizeAndColors), views_of_query,
                     squares_of_query, 1, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    return squared;
  }

  /// The views whose beginnings are nearer, as if all had colours.
  [[nodiscard]] std::vector<std::size_t> near_of_all(SizeAndColors scaled,
                                                     float most_squared) const {
    std::vector<std::vector<std::size_t>> found;
    std::vector<std::vector<float>> squares;
    flann::SearchParams parameters(flann::FLANN_CHECKS_UNLIMITED);
    parameters.sorted = false;
    index->radiusSearch(flann::Matrix<float>(scaled.data(), 1, kSizeAndColors), found, squares,
                        most_squared, parameters);
    return std::move(found.front());
  }
};

ModelIndex::ModelIndex(const std::vector<IndexedView>& views)
    : search_(std::make_unique<Search>()) {
  if (views.empty()) return;
  search_->inverse_deviation =
      deviation_between_views(views).cwiseInverse().cwiseProduct(weights());
  search_->views = views;
  search_->data.reserve(views.size() * kSizeAndColors);
  for (std::size_t i = 0; i < views.size(); ++i) {
    ViewDescriptor& descriptor = search_->views[i].descriptor;
    descriptor = descriptor.cwiseProduct(search_->inverse_deviation);
    const SizeAndColors beginning = descriptor.head<kSizeAndColors>();
    search_->data.insert(search_->data.end(), beginning.begin(), beginning.end());
    if (!has_colors(beginning)) search_->without_colors.push_back(i);
  }
  // Exact, so that the result is the same in every run: FLANN's trees for approximate search are
  // random. Of the beginnings only, so that least_distance() can ask it, too.
  search_->index = std::make_unique<flann::Index<flann::L2<float>>>(
      flann::Matrix<float>(search_->data.data(), views.size(), kSizeAndColors),
      flann::KDTreeSingleIndexParams());
  search_->index->buildIndex();
}

ModelIndex::~ModelIndex() = default;
ModelIndex::ModelIndex(ModelIndex&&) noexcept = default;
ModelIndex& ModelIndex::operator=(ModelIndex&&) noexcept = default;

float ModelIndex::least_distance(const SizeAndColors& beginning) const {
  if (search_->views.empty()) return std::numeric_limits<float>::infinity();
  const auto scale = search_->inverse_deviation.head<kSizeAndColors>();
  return distance_of(search_->least_squared(beginning.cwiseProduct(scale)));
}

std::vector<ModelMatch> ModelIndex::nearest(const ViewDescriptor& descriptor, std::size_t count,
                                            float distance) const {
  if (search_->views.empty()) return {};
  const ViewDescriptor scaled = descriptor.cwiseProduct(search_->inverse_deviation);
  const float most = squared(distance);
  std::vector<ModelMatch> matches;  // the nearest view of each object; distances are squared yet
  for (const std::size_t i : search_->near(scaled.head<kSizeAndColors>(), most)) {
    const IndexedView& view = search_->views[i];
    const float square = squared_distance(view.descriptor, scaled);
    if (square > most) continue;
    // Views of one object follow each other.
    if (matches.empty() || matches.back().model != view.model) {
      matches.push_back({view.model, square});
    } else {
      matches.back().distance = std::min(matches.back().distance, square);
    }
  }
  const auto wanted = static_cast<std::ptrdiff_t>(std::min(count, matches.size()));
  std::ranges::partial_sort(matches, matches.begin() + wanted, [](const auto& a, const auto& b) {
    return std::tie(a.distance, a.model) < std::tie(b.distance, b.model);
  });
  matches.resize(static_cast<std::size_t>(wanted));
  for (ModelMatch& match : matches) match.distance = distance_of(match.distance);
  return matches;
}

}  // namespace kintsugi::segmenter
