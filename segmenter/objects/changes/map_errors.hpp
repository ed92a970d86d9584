#pragma once
// How far two maps of a place are apart where nothing has changed.

#include "segmenter/objects/changes/map_side.hpp"
#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

/// For the grids of both maps a voxel, and one for the error of the alignment.
inline constexpr double kLeastError_vox = 2.0;

/// What is nearer, in place or colour, is the same.
struct MapErrors {
  double distance_m = 0.0;
  float color = kSameColor;  ///< in CIELAB
};

/// kLeastError_vox and kSameColor; but more where the maps differ by more all over: a camera that
/// was tracked less well bends its map by some centimetres, and one that sets its exposure anew
/// shows one surface in several brightnesses.
MapErrors errors_of(const MapSide& before, const MapSide& after);

}  // namespace kintsugi::segmenter
