#pragma once
// Scores of changes and detections, for people and for programs.

#include <filesystem>
#include <string>
#include <vector>

#include "segmenter/evaluation/objects/object_scores.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {

/// Precision and recall by size class, and by kind where there are several.
Table summary_table(const ObjectScores& scores);
/// One row for each object that should have been found.
Table truth_table(const ObjectScores& scores);
/// One row for each claim.
Table claims_table(const ObjectScores& scores);

/// Moved objects of 500 points and more told as moved, with a motion within 2 cm and 5 degrees.
struct MovedShare {
  std::int64_t num_true = 0;
  std::int64_t num_right = 0;
};
MovedShare moved_share(const ObjectScores& scores);

/// Claims that are not right, of 200 points and more.
std::int64_t num_large_false_claims(const ObjectScores& scores);

std::string to_text(const ObjectScores& scores);
std::string to_json(const ObjectScores& scores);

/// Writes scores.json, summary.csv, objects.csv, claims.csv and the figure sizes.gp (and .svg where
/// there is gnuplot) into the folder, which is made when absent.
/// @throws std::runtime_error or std::system_error naming the file that cannot be written
void write_objects_report(const ObjectScores& scores, const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
