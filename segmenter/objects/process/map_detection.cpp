#include "segmenter/objects/process/map_detection.hpp"

#include <memory>

#include "segmenter/io/cloud_slices.hpp"
#include "segmenter/objects/process/cpu_budget.hpp"

namespace kintsugi::segmenter {

std::vector<ObjectModel> models_of(const ObjectLibrary& library) {
  std::vector<ObjectModel> models;
  models.reserve(library.objects().size());
  for (const KnownObject& object : library.objects()) {
    ObjectModel& model = models.emplace_back(object.model);
    if (object.lessons.empty()) continue;
    const std::int64_t session = object.lessons.front().map_session;
    if (session != kCloudSession) model.map_session = session;
  }
  return models;
}

MapDetection detect_in(const ObservedMap& map, const ObjectLibrary& library) {
  MapDetection found;
  const double start_s = CpuBudget::cpu_s();
  found.detector =
      std::make_unique<Detector>(models_of(library), map.resolution_m, map.map_session);
  const double prepared_s = CpuBudget::cpu_s();
  Detector& detector = *found.detector;
  detector.set_piece(0, std::make_shared<const std::vector<CloudPoint>>(map.points_W),
                     map.segment_ids, 0);
  detector.set_views(map.views);
  detector.examine_all();
  found.cost.num_segments = detector.num_waiting();
  while (detector.num_waiting() > 0) detector.examine_many();
  found.cost.prepare_s = prepared_s - start_s;
  found.cost.examine_s = CpuBudget::cpu_s() - prepared_s;
  return found;
}

}  // namespace kintsugi::segmenter
