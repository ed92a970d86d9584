#pragma once
// Why a detection is false, and why an object was missed, as far as the map tells.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "segmenter/evaluation/objects/detection_scores.hpp"

namespace kintsugi::segmenter {

/// The map in which objects were detected.
struct LabelledPoints {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;  ///< of each point
  float resolution_m = 0.0F;               ///< spacing of the points
};

/// @throws std::runtime_error naming the file: not readable, no labels, no two points
LabelledPoints read_labelled_cloud(const std::filesystem::path& path);

/// Adds to the reason of each false detection what is at its place, and how much of its surface is
/// in the map; and tells of each object that was missed how well one segment matches it, how much
/// of its model is in the map, and what was told instead.
/// @param told those of which `scores` are, in the same order
void explain(const std::vector<ToldDetection>& told, const Truth& truth, const LabelledPoints& map,
             const std::filesystem::path& library, ObjectScores& scores);

}  // namespace kintsugi::segmenter
