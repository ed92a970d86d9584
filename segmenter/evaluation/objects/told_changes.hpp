#pragma once
// The files of kintsugi-diff.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct ToldChange {
  std::int64_t id = 0;
  std::string kind;                    ///< "new", "gone", "moved"
  std::optional<Pose> X_after_before;  ///< in AFTER's W
  std::vector<CloudPoint> was_W;       ///< its points as they were before, in AFTER's W
  std::vector<CloudPoint> is_W;        ///< and as they are now
};

struct ToldChanges {
  Pose X_AB = Pose::Identity();  ///< of BEFORE's W in AFTER's W
  std::vector<ToldChange> changes;
};

/// Reads changes.json and change_ID.ply.
/// @throws std::runtime_error naming the file and what is missing or of another type
ToldChanges read_told_changes(const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
