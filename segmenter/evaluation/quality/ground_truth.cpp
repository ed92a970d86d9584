#include "segmenter/evaluation/quality/ground_truth.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "segmenter/core/points/admission.hpp"
#include "segmenter/evaluation/quality/overlap.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

/// Parses `instance ID structure|object NAME`; nothing for any other comment.
std::optional<TruthInstance> parse_instance(const std::string& comment) {
  std::istringstream words(comment);
  std::string keyword;
  std::string kind;
  TruthInstance instance;
  if (!(words >> keyword >> instance.id >> kind) || keyword != "instance") return std::nullopt;
  if (kind != "structure" && kind != "object") return std::nullopt;
  instance.is_object = kind == "object";
  std::getline(words >> std::ws, instance.name);
  return instance;
}

std::map<std::uint32_t, TruthInstance> described_instances(const PlyCloud& cloud,
                                                           const std::string& name) {
  std::map<std::uint32_t, TruthInstance> described;
  for (const std::string& comment : cloud.comments) {
    const auto instance = parse_instance(comment);
    if (instance && !described.emplace(instance->id, *instance).second) {
      throw std::runtime_error(
          fmt::format("{}: instance {} is described a second time, by 'comment {}'", name,
                      instance->id, comment));
    }
  }
  return described;
}

void take_points(const PlyCloud& cloud, Truth& truth) {
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    if (reason_to_reject_position(cloud.points_W[i])) continue;
    truth.points_W.push_back(cloud.points_W[i]);
    truth.instance_ids.push_back(cloud.instance_ids[i]);
  }
}

}  // namespace

std::set<std::uint32_t> Truth::objects() const {
  std::set<std::uint32_t> ids;
  for (const TruthInstance& instance : instances) {
    if (instance.is_object) ids.insert(instance.id);
  }
  return ids;
}

Truth make_truth(const PlyCloud& cloud, const std::string& name) {
  if (cloud.instance_ids.size() != cloud.points_W.size()) {
    throw std::runtime_error(name + ": element 'vertex' lacks property 'instance_id'");
  }
  Truth truth;
  truth.source = name;
  take_points(cloud, truth);
  if (truth.points_W.empty()) throw std::runtime_error(name + ": holds no points");
  const auto described = described_instances(cloud, name);
  std::set<std::uint32_t> ids(truth.instance_ids.begin(), truth.instance_ids.end());
  ids.erase(kNoInstance);
  for (const std::uint32_t id : ids) {
    const auto found = described.find(id);
    if (found == described.end() && !described.empty()) {
      throw std::runtime_error(name + ": no line 'comment instance " + std::to_string(id) +
                               " structure|object NAME', expected one for each instance, or none");
    }
    truth.instances.push_back(found == described.end() ? TruthInstance{.id = id, .name = ""}
                                                       : found->second);
  }
  return truth;
}

Truth read_truth(const std::filesystem::path& path) {
  return make_truth(read_ply(path), path.string());
}

std::vector<std::uint32_t> instances_at(std::span<const CloudPoint> points_W, const Truth& truth,
                                        double max_distance_m) {
  NearestNeighbours::Result nearest;
  NearestNeighbours(truth.points_W).find(points_W, 1, nearest);
  const auto max_squared_m2 = static_cast<float>(max_distance_m * max_distance_m);
  std::vector<std::uint32_t> instances(points_W.size(), kNoInstance);
  for (std::size_t i = 0; i < points_W.size() && nearest.count == 1; ++i) {
    if (nearest.squared_distances[i] > max_squared_m2) continue;
    instances[i] = truth.instance_ids[nearest.indices[i]];
  }
  return instances;
}

}  // namespace kintsugi::segmenter
