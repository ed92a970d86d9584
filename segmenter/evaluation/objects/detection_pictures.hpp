#pragma once
// Pictures of what was detected falsely, and of what was missed.

#include <filesystem>
#include <string>
#include <vector>

#include "segmenter/evaluation/objects/detection_reasons.hpp"

namespace kintsugi::segmenter {

struct DetectionPicture {
  std::string file;  ///< in the folder
  std::string caption;
};

/// Writes a PNG file for each false detection (`false_ID.png`) and each missed object
/// (`missed_INSTANCE.png`): the map around the place in its colours, the object's model in the pose
/// that was told, or, of a missed one, in the true one, and the segments; and `pictures.html` with
/// all of them. What was written by an earlier call is removed.
/// @param told those of which `scores` are, in the same order
/// @throws std::runtime_error or std::system_error naming the file that cannot be read or written
std::vector<DetectionPicture> write_detection_pictures(
    const std::vector<ToldDetection>& told, const ObjectScores& scores, const LabelledPoints& map,
    const Truth& truth, const std::filesystem::path& library, const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
