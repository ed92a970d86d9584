#pragma once
// What an evaluation needs of an object in a library.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct TaughtModel {
  std::vector<CloudPoint> points_O;
  /// Where it stood in the map in which it was first taught; nothing: the library does not tell.
  std::optional<Pose> X_WO{};
};

/// The name in the library under which an object is expected: its key with '_' for blanks.
std::string library_name(std::string key);

/// @param library the folder of NAME/model.ply and NAME/object.json
/// @throws std::runtime_error naming the file that cannot be read
TaughtModel read_taught_model(const std::filesystem::path& library, const std::string& name);

}  // namespace kintsugi::segmenter
