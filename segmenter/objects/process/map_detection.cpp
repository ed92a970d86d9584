#include "segmenter/objects/process/map_detection.hpp"

#include <memory>
#include <vector>

namespace kintsugi::segmenter {

std::vector<ObjectModel> models_of(const ObjectLibrary& library) {
  std::vector<ObjectModel> models;
  models.reserve(library.objects().size());
  for (const KnownObject& object : library.objects()) models.push_back(object.model);
  return models;
}

std::unique_ptr<Detector> detect_in(const ObservedMap& map, const ObjectLibrary& library) {
  auto detector = std::make_unique<Detector>(models_of(library), map.resolution_m);
  detector->set_piece(0, std::make_shared<const std::vector<CloudPoint>>(map.points_W),
                      map.segment_ids, 0);
  detector->set_views(map.views);
  detector->examine_all();
  while (detector->num_waiting() > 0) detector->examine_next();
  return detector;
}

}  // namespace kintsugi::segmenter
