#pragma once
// Finds the objects of a library in a whole map.

#include <memory>

#include "segmenter/objects/detection/detector.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

/// A detector that has looked at all of the map.
std::unique_ptr<Detector> detect_in(const ObservedMap& map, const ObjectLibrary& library);

/// The models of a library, by name.
std::vector<ObjectModel> models_of(const ObjectLibrary& library);

}  // namespace kintsugi::segmenter
