#pragma once
// What is known of an object: its surface in a frame of its own, and how it comes out of a map.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/objects/model/empty_space.hpp"

namespace kintsugi::segmenter {

/// Frame O of an object: the origin is the mean of its points when it was first taught; z is up if
/// has_up, and else the axes are those of the map in which it was first taught.
struct ObjectModel {
  std::string name;
  float resolution_m = 0.0F;  ///< spacing of the points, > 0
  bool has_up = false;        ///< the map in which it was taught told which direction is up
  std::vector<CloudPoint> points_O;
  std::vector<Eigen::Vector3f> views_O;  ///< unit vectors towards the cameras that saw it
  EmptySpace empty_O;                    ///< what was seen around it
  EngineConfig parameters;  ///< with which it comes out whole; resolution_m is the map's
  std::int32_t times_taught = 1;
  /// Of the mapper whose map has the light of the colours, that of its first lesson; 0: not known.
  std::int64_t map_session = 0;
};

}  // namespace kintsugi::segmenter
