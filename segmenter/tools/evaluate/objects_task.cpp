#include "segmenter/tools/evaluate/objects_task.hpp"

#include <iostream>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/evaluation/objects/change_scores.hpp"
#include "segmenter/evaluation/objects/detection_pictures.hpp"
#include "segmenter/evaluation/objects/detection_reasons.hpp"
#include "segmenter/evaluation/objects/detection_scores.hpp"
#include "segmenter/evaluation/objects/detection_times.hpp"
#include "segmenter/evaluation/objects/objects_report.hpp"
#include "segmenter/evaluation/objects/told_changes.hpp"
#include "segmenter/evaluation/objects/true_objects.hpp"
#include "segmenter/evaluation/quality/ground_truth.hpp"
#include "segmenter/evaluation/report/text_file.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

ObjectScores score(const ObjectsOptions& options, const TrueObjects& objects, const Truth& after) {
  constexpr double kVoxels = 3.0;  // by which noise and alignment may move a point
  return score_changes(read_told_changes(options.changes_folder), objects,
                       read_truth(options.before_truth_file), after,
                       kVoxels * static_cast<double>(median_spacing_m(after.points_W)));
}

/// With the map also reasons, and pictures in the folder unless that is empty.
ObjectScores score_and_explain(const ObjectsOptions& options, const TrueObjects& objects,
                               const Truth& truth, const std::filesystem::path& folder) {
  const std::vector<ToldDetection> told = read_told_detections(options.detections_file);
  ObjectScores scores = score_detections(told, objects, truth, options.taught, options.library);
  if (options.map_file.empty()) return scores;
  const LabelledPoints map = read_labelled_cloud(options.map_file);
  explain(told, truth, map, options.library, scores);
  if (!folder.empty()) {
    write_detection_pictures(told, scores, map, truth, options.library, folder);
  }
  return scores;
}

}  // namespace

void add_objects_options(CLI::App& app, ObjectsOptions& options) {
  auto* const changes =
      app.add_option("--changes", options.changes_folder,
                     "instead of IN: the folder of kintsugi-diff, whose changes are scored");
  auto* const objects = app.add_option("--objects", options.detections_file,
                                       "instead of IN: the detections of kintsugi-objects (JSON), "
                                       "which are scored")
                            ->excludes(changes);
  auto* const truth = app.add_option("--truth-objects", options.objects_truth_file,
                                     "the file of kintsugi-ground-truth --changes or --objects");
  auto* const before =
      app.add_option("--before-truth", options.before_truth_file,
                     "of --changes: PLY of kintsugi-ground-truth of the map BEFORE")
          ->needs(changes);
  auto* const after = app.add_option("--after-truth", options.after_truth_file,
                                     "PLY of kintsugi-ground-truth of the map AFTER, or of the map "
                                     "in which objects were detected")
                          ->needs(truth);
  app.add_option("--taught", options.taught,
                 "of --objects: names in the library, keys of true objects with '_' for blanks; "
                 "default: those that were detected")
      ->needs(objects)
      ->delimiter(',')
      ->allow_extra_args(false);
  auto* const library = app.add_option("--library", options.library,
                                       "of --objects: the folder of the library, for the poses "
                                       "and the distance of the surfaces")
                            ->needs(objects);
  app.add_option("--detected-in", options.map_file,
                 "of --objects: labelled PLY file of the map in which was detected, for the "
                 "reasons of what is false or missed; with --out a picture of each")
      ->needs(objects)
      ->needs(library);
  app.add_option("--detection-times", options.times_log,
                 "instead of IN: the log of everything that was on the bus of a live run with "
                 "kintsugi-objects detect (run.lcm of scripts/trio --objects); prints how soon "
                 "objects were told")
      ->excludes(objects)
      ->excludes(changes);
  changes->needs(truth)->needs(before)->needs(after);
  objects->needs(truth)->needs(after);
}

int evaluate_detection_times(const std::filesystem::path& log,
                             const std::filesystem::path& json_file) {
  const DetectionTimes times = read_detection_times(log);
  for (const std::string& remark : times.remarks) spdlog::warn("{}", remark);
  if (!json_file.empty()) write_text_file(json_file, to_json(times));
  std::cout << to_text(times) << std::flush;
  return times.is_whole ? 0 : 1;
}

void evaluate_objects(const ObjectsOptions& options, const std::filesystem::path& folder) {
  const TrueObjects objects = read_true_objects(options.objects_truth_file);
  const Truth after = read_truth(options.after_truth_file);
  const ObjectScores scores = options.changes_folder.empty()
                                  ? score_and_explain(options, objects, after, folder)
                                  : score(options, objects, after);
  if (!folder.empty()) write_objects_report(scores, folder);
  std::cout << to_text(scores) << std::flush;
}

}  // namespace kintsugi::segmenter
