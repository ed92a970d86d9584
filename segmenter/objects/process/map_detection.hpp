#pragma once
// Finds the objects of a library in a whole map.

#include <cstddef>
#include <memory>

#include "segmenter/objects/detection/detector.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

/// What looking at a map has cost, in seconds of processor time.
struct DetectionCost {
  double prepare_s = 0.0;  ///< the models of the library, once for each start
  double examine_s = 0.0;
  std::size_t num_segments = 0;
};

struct MapDetection {
  std::unique_ptr<Detector> detector;  ///< has looked at all of the map
  DetectionCost cost;
};

MapDetection detect_in(const ObservedMap& map, const ObjectLibrary& library);

/// The models of a library, by name.
std::vector<ObjectModel> models_of(const ObjectLibrary& library);

}  // namespace kintsugi::segmenter
