#include "mapper/evaluation/scene_pairs.hpp"

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "mapper/synthetic/render/instance_json.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::mapper {
namespace {

using Json = nlohmann::ordered_json;
using synthetic::Instance;
using synthetic::numbers_of;
using synthetic::symmetry_json;

Json head_of(const MappedScene& mapped) {
  return {{"scene", mapped.address}, {"X_SW", numbers_of(mapped.X_SW)}};
}

const Instance* with_key(const synthetic::Scene& scene, const std::string& key) {
  const auto found = std::ranges::find(scene.instances(), key, &Instance::key);
  return found == scene.instances().end() ? nullptr : &*found;
}

void add_places(const Instance* before, const Instance* after, Json& entry) {
  if (before != nullptr) {
    entry["id_before"] = before->id;
    entry["X_SG_before"] = numbers_of(before->X_WG);
  }
  if (after != nullptr) {
    entry["id_after"] = after->id;
    entry["X_SG_after"] = numbers_of(after->X_WG);
  }
}

Json change_of(const Instance* before, const Instance* after, const synthetic::Scene& scene) {
  const Instance& either = before != nullptr ? *before : *after;
  const char* const kind = before == nullptr ? "new" : after == nullptr ? "gone" : "moved";
  Json entry = {
      {"key", either.key}, {"model", either.model}, {"name", either.name}, {"kind", kind}};
  add_places(before, after, entry);
  if (before != nullptr && after != nullptr) {
    entry["X_after_before_S"] = numbers_of(Pose(after->X_WG * before->X_WG.inverse()));
  }
  entry["symmetry"] = symmetry_json(either, scene);
  return entry;
}

Json changes_between(const synthetic::Scene& before, const synthetic::Scene& after) {
  Json changes = Json::array();
  for (const Instance& was : before.instances()) {
    const Instance* const is = with_key(after, was.key);
    if (was.is_structure || (is != nullptr && is->X_WG.isApprox(was.X_WG, 0.0))) continue;
    changes.push_back(change_of(&was, is, before));
  }
  for (const Instance& is : after.instances()) {
    if (is.is_structure || with_key(before, is.key) != nullptr) continue;
    changes.push_back(change_of(nullptr, &is, after));
  }
  return changes;
}

Json pairs_between(const synthetic::Scene& before, const synthetic::Scene& after) {
  Json pairs = Json::array();
  for (const Instance& one : before.instances()) {
    for (const Instance& other : after.instances()) {
      if (one.is_structure || other.is_structure || one.model != other.model) continue;
      Json entry = {{"model", one.model},
                    {"key_before", one.key},
                    {"key_after", other.key},
                    {"name", one.name},
                    {"kind", "same object"}};
      add_places(&one, &other, entry);
      entry["symmetry"] = symmetry_json(one, before);
      pairs.push_back(entry);
    }
  }
  return pairs;
}

}  // namespace

std::string scene_pairs_json(const MappedScene& before, const MappedScene& after,
                             bool with_changes) {
  Json json = {{"before", head_of(before)}, {"after", head_of(after)}};
  if (with_changes) json["changes"] = changes_between(before.scene, after.scene);
  json["objects"] = pairs_between(before.scene, after.scene);
  return json.dump(1) + "\n";
}

}  // namespace kintsugi::mapper
