#pragma once
// What two synthetic scenes have in common, and what changed between them, as JSON.

#include <string>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::synthetic {
class Scene;
}

namespace kintsugi::mapper {

/// A scene that was mapped.
struct MappedScene {
  std::string address;  ///< synthetic://NAME?...
  const synthetic::Scene& scene;
  Pose X_SW = Pose::Identity();  ///< of the map frame in the scene frame
};

/// {"before", "after": {"scene", "X_SW"}, "changes": [...], "objects": [...]}. Poses are 12
/// numbers, the rows of 3 x 4. An entry of "changes" is an object whose key is in one of the scenes
/// alone
/// ("gone", "new"), or that has another pose in the second ("moved"):
///   key, model, name, kind, id_before, id_after, X_SG_before, X_SG_after (where they exist),
///   X_after_before_S (moved: takes its points in the scene's frame to where they are now),
///   symmetry
/// An entry of "objects" is a pair of objects of the same model, one in each scene:
///   model, key_before, key_after, name, kind "same object", id_before, id_after, X_SG_before,
///   X_SG_after, symmetry
/// `symmetry` is as in instances.json.
/// @param with_changes false: the scenes are different rooms, and "changes" is absent
std::string scene_pairs_json(const MappedScene& before, const MappedScene& after,
                             bool with_changes);

}  // namespace kintsugi::mapper
