#pragma once
// Which of the objects of a library were found in a map, and which detections are true.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "segmenter/evaluation/objects/object_scores.hpp"
#include "segmenter/evaluation/objects/true_objects.hpp"
#include "segmenter/evaluation/quality/ground_truth.hpp"

namespace kintsugi::segmenter {

/// What was last said of one detection.
struct ToldDetection {
  std::int64_t id = 0;
  std::string name;  ///< in the library
  Pose X_WO = Pose::Identity();
  Eigen::AlignedBox3d box_O;
  std::int64_t points = 0;
  std::optional<double> score{};
  std::optional<std::int64_t> found_utime{};  ///< when it was first told
};

/// Of a file of kintsugi-objects detect: the last entry of each detection; those whose last event
/// is "gone" are left out.
/// @throws std::runtime_error naming the file and what is missing or of another type
std::vector<ToldDetection> read_told_detections(const std::filesystem::path& path);

/// Expected are the objects that are in the scene after, are of the same model as a taught one, and
/// have 50 points and more in `truth`. A detection is right if its name is that of such an object,
/// the middle of its box lies within half the object's largest extent of the object's middle, and
/// no nearer detection claims the same object.
/// @param truth in the W of the map in which was detected
/// @param taught names in the library; empty: all names that `told` has
/// The error of the pose is that of the middle of the box, or, where the library tells how the
/// object stood in the map BEFORE in which it was first taught, that of the pose.
/// @param library folder of NAME/model.ply, for poses and the distance of the surfaces; empty: none
/// @throws std::runtime_error when a model cannot be read
ObjectScores score_detections(const std::vector<ToldDetection>& told, const TrueObjects& objects,
                              const Truth& truth, const std::vector<std::string>& taught,
                              const std::filesystem::path& library);

}  // namespace kintsugi::segmenter
