#pragma once
// The parameters of the segmentation with which an object comes out whole.

#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/objects/teaching/taught_surface.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

struct LearnedParameters {
  EngineConfig parameters;  ///< resolution_m is the map's
  /// As KnownObject::wholeness.
  double wholeness = 0.0;
};

/// As Finman et al. (ECMR 2013) learn them: the surroundings of the object are segmented (mode
/// batch) with thresholds T, scales k and colour weights around those of the preset `objects`, and
/// the parameters that give the segment most like the object are taken. Within one per cent, those
/// nearest to the preset are. Deterministic, whatever the threads.
LearnedParameters learned_parameters(const ObservedMap& map, const TaughtSurface& surface);

}  // namespace kintsugi::segmenter
