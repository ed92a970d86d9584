#pragma once
// Known objects as a table for people and as JSON for programs.

#include <string>

#include "segmenter/tools/query/object_query.hpp"

namespace kintsugi::segmenter {

/// A line for each detection, under a header. Poses X_WO as translation (metres) and quaternion
/// (x y z w).
std::string objects_table(const FoundObjects& found);

/// One JSON object: `map` (name, map_session, session of the detector) and `objects`, each with
/// name, detection, state, score, pose of O in W (translation in metres, quaternion x y z w), box in
/// O, points, segments, utime and age_s: how long before the newest slice it was looked at.
std::string objects_json(const FoundObjects& found);

}  // namespace kintsugi::segmenter
