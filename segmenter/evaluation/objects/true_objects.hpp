#pragma once
// The file of kintsugi-ground-truth --changes and --objects.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "segmenter/evaluation/objects/pose_error.hpp"

namespace kintsugi::segmenter {

/// One object that changed, or that is in both scenes. S: the frame of the scenes; G: of the
/// object.
struct TrueObject {
  std::string key;                         ///< in the scene before; of what is new: after
  std::string model;                       ///< the same for things of one make
  std::string kind;                        ///< "new", "gone", "moved", "same object"
  std::optional<std::uint32_t> id_before;  ///< of the instance, in the true cloud
  std::optional<std::uint32_t> id_after;
  Pose X_SG_before = Pose::Identity();  ///< where there is an id
  Pose X_SG_after = Pose::Identity();
  Symmetry symmetry;
};

struct TrueObjects {
  Pose X_SW_before = Pose::Identity();  ///< of the map frames in the scene's
  Pose X_SW_after = Pose::Identity();
  std::vector<TrueObject> changes;
  std::vector<TrueObject> objects;  ///< each pair of the same model
};

/// @throws std::runtime_error naming the file and what is missing or of another type
TrueObjects read_true_objects(const std::filesystem::path& path);

/// A pose as 12 numbers, the rows of 3 x 4.
/// @throws std::invalid_argument unless there are 12
Pose pose_of(const std::vector<double>& numbers);

}  // namespace kintsugi::segmenter
