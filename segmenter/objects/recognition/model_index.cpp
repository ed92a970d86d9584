#include "segmenter/objects/recognition/model_index.hpp"

#include <algorithm>
#include <cmath>
#include <map>
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

}  // namespace

struct ModelIndex::Search {
  ViewDescriptor inverse_deviation;
  std::vector<std::size_t> models;  // of each view
  std::vector<float> data;          // descriptors, one after the other
  std::unique_ptr<flann::Index<flann::L2<float>>> index;
};

ModelIndex::ModelIndex(const std::vector<IndexedView>& views)
    : search_(std::make_unique<Search>()) {
  if (views.empty()) return;
  search_->inverse_deviation =
      deviation_between_views(views).cwiseInverse().cwiseProduct(weights());
  search_->models.reserve(views.size());
  search_->data.reserve(views.size() * kViewDescriptorSize);
  for (const IndexedView& view : views) {
    search_->models.push_back(view.model);
    const ViewDescriptor scaled = view.descriptor.cwiseProduct(search_->inverse_deviation);
    search_->data.insert(search_->data.end(), scaled.begin(), scaled.end());
  }
  // Exact, so that the result is the same in every run: FLANN's trees for approximate search are
  // random.
  search_->index = std::make_unique<flann::Index<flann::L2<float>>>(
      flann::Matrix<float>(search_->data.data(), views.size(), kViewDescriptorSize),
      flann::KDTreeSingleIndexParams());
  search_->index->buildIndex();
}

ModelIndex::~ModelIndex() = default;
ModelIndex::ModelIndex(ModelIndex&&) noexcept = default;
ModelIndex& ModelIndex::operator=(ModelIndex&&) noexcept = default;

bool ModelIndex::has_near(const SizeAndColors& beginning, float distance) const {
  const SizeAndColors scaled =
      beginning.cwiseProduct(search_->inverse_deviation.head<kSizeAndColors>());
  const float most = distance * distance * static_cast<float>(kViewDescriptorSize);
  for (std::size_t i = 0; i < search_->models.size(); ++i) {
    const Eigen::Map<const SizeAndColors> view(search_->data.data() + i * kViewDescriptorSize);
    if ((view - scaled).squaredNorm() <= most) return true;
  }
  return false;
}

std::vector<ModelMatch> ModelIndex::nearest(const ViewDescriptor& descriptor,
                                            std::size_t count) const {
  std::vector<ModelMatch> matches;
  if (search_->models.empty()) return matches;
  ViewDescriptor scaled = descriptor.cwiseProduct(search_->inverse_deviation);
  // An object has up to 17 views, so with as many neighbours there are at least `count` objects.
  const std::size_t wanted = std::min(search_->models.size(), count * 17);
  std::vector<int> indices(wanted);
  std::vector<float> squares(wanted);
  flann::Matrix<int> found(indices.data(), 1, wanted);
  flann::Matrix<float> distances(squares.data(), 1, wanted);
  search_->index->knnSearch(flann::Matrix<float>(scaled.data(), 1, kViewDescriptorSize), found,
                            distances, wanted, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  for (std::size_t i = 0; i < wanted && matches.size() < count; ++i) {
    const std::size_t model = search_->models[static_cast<std::size_t>(indices[i])];
    const bool is_known = std::any_of(matches.begin(), matches.end(),
                                      [model](const ModelMatch& m) { return m.model == model; });
    if (is_known) continue;
    matches.push_back({model, std::sqrt(squares[i] / static_cast<float>(kViewDescriptorSize))});
  }
  return matches;
}

}  // namespace kintsugi::segmenter
