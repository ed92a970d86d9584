#include "segmenter/tools/evaluate/objects_task.hpp"

#include <iostream>

#include <CLI/CLI.hpp>

#include "segmenter/evaluation/objects/change_scores.hpp"
#include "segmenter/evaluation/objects/detection_scores.hpp"
#include "segmenter/evaluation/objects/objects_report.hpp"
#include "segmenter/evaluation/objects/told_changes.hpp"
#include "segmenter/evaluation/objects/true_objects.hpp"
#include "segmenter/evaluation/quality/ground_truth.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {

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
  app.add_option("--library", options.library,
                 "of --objects: the folder of the library, for the distance of the surfaces")
      ->needs(objects);
  changes->needs(truth)->needs(before)->needs(after);
  objects->needs(truth)->needs(after);
}

void evaluate_objects(const ObjectsOptions& options, const std::filesystem::path& folder) {
  constexpr double kVoxels = 3.0;  // by which noise and alignment may move a point
  const TrueObjects objects = read_true_objects(options.objects_truth_file);
  const Truth after = read_truth(options.after_truth_file);
  const ObjectScores scores =
      options.changes_folder.empty()
          ? score_detections(read_told_detections(options.detections_file), objects, after,
                             options.taught, options.library)
          : score_changes(read_told_changes(options.changes_folder), objects,
                          read_truth(options.before_truth_file), after,
                          kVoxels * static_cast<double>(median_spacing_m(after.points_W)));
  if (!folder.empty()) write_objects_report(scores, folder);
  std::cout << to_text(scores) << std::flush;
}

}  // namespace kintsugi::segmenter
