#include "tests/fuzz/engine_check.hpp"

#include <algorithm>
#include <sstream>

#include "tests/fuzz/partition.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

/// The k-th point of both partitions is the k-th of `live`.
std::optional<std::string> difference(const Partition& found, const Partition& expected,
                                      std::span<const PointIndex> live) {
  std::size_t num_labels = 0;
  std::size_t num_thetas = 0;
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < live.size(); ++k) {
    const bool label_differs = found.labels[k] != expected.labels[k];
    const bool theta_differs = found.thetas[k] != expected.thetas[k];
    num_labels += label_differs;
    num_thetas += theta_differs;
    if (!first && (label_differs || theta_differs)) first = k;
  }
  if (!first) return std::nullopt;
  return text("of ", live.size(), " points ", num_labels, " labels and ", num_thetas,
              " thetas differ from batch; first point ", live[*first], ": label ",
              live[found.labels[*first]], ", batch ", live[expected.labels[*first]], "; theta ",
              found.thetas[*first], ", batch ", expected.thetas[*first]);
}

}  // namespace

std::optional<std::string> EngineCheck::operator()(const CloudChange& change,
                                                   std::span<const PointIndex> live) {
  if (auto wrong = check_names(live)) return wrong;
  if (auto wrong = partition(live)) return wrong;
  return check_changed(change, live);
}

/// A name below size() for each point in the map, kNoComponent for every other.
std::optional<std::string> EngineCheck::check_names(std::span<const PointIndex> live) const {
  const std::span<const ComponentId> components = engine_.components();
  if (components.size() != cloud_.size()) {
    return text("components() has ", components.size(), " points, the cloud ", cloud_.size());
  }
  auto next = live.begin();
  for (PointIndex i = 0; i < components.size(); ++i) {
    const bool is_live = next != live.end() && *next == i;
    if (is_live) ++next;
    if (is_live && components[i] >= components.size()) {
      return text("point ", i, " is in component ", components[i], " of ", components.size());
    }
    if (!is_live && components[i] != kNoComponent) {
      return text("point ", i, " is gone but in component ", components[i]);
    }
  }
  return std::nullopt;
}

/// changed() names the added points and those whose component has another name, and no others.
std::optional<std::string> EngineCheck::check_changed(const CloudChange& change,
                                                      std::span<const PointIndex> live) {
  const std::span<const ComponentId> components = engine_.components();
  mirror_.resize(components.size(), kNoComponent);
  for (const PointIndex i : change.removed) mirror_[i] = kNoComponent;
  for (const PointIndex i : change.added) mirror_[i] = kNoComponent;
  std::vector<PointIndex> expected;
  for (const PointIndex i : live) {
    if (mirror_[i] != components[i]) expected.push_back(i);
  }
  const std::span<const PointIndex> changed = engine_.changed();
  if (!std::ranges::equal(changed, expected)) {
    const auto differs = std::ranges::mismatch(changed, expected);
    const bool at_end = differs.in1 == changed.end();
    return text("changed() has ", changed.size(), " points, expected ", expected.size(),
                "; at place ", differs.in1 - changed.begin(), " it has ",
                at_end ? "none" : text("point ", *differs.in1), ", expected ",
                differs.in2 == expected.end() ? "none" : text("point ", *differs.in2));
  }
  for (const PointIndex i : changed) mirror_[i] = components[i];
  return std::nullopt;
}

std::optional<std::string> EngineCheck::partition(std::span<const PointIndex> live) const {
  const Partition found = partition_of(engine_, engine_.unmerged_components(), live);
  if (config_.fragment_limit() == 0) {
    std::vector<CloudPoint> points_W;
    points_W.reserve(live.size());
    for (const PointIndex i : live) points_W.push_back(cloud_[i]);
    return difference(found, batch_partition(points_W, config_), live);
  }
  const BatchPartitions expected = batch_partitions(cloud_, live, config_);
  if (auto wrong = difference(found, expected.unmerged, live)) return wrong;
  const auto wrong =
      difference(partition_of(engine_, engine_.components(), live), expected.joined, live);
  return wrong ? std::optional("with fragments joined, " + *wrong) : std::nullopt;
}

}  // namespace kintsugi::segmenter::fuzz
