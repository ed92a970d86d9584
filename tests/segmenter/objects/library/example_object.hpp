#pragma once
// An object for tests.

#include <cmath>
#include <string>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/objects/library/known_object.hpp"

namespace kintsugi::segmenter::testing {

/// A quarter of a cylinder, seen from two sides.
inline KnownObject example_object(const std::string& name) {
  KnownObject object;
  object.model.name = name;
  object.model.resolution_m = 0.005F;
  object.model.has_up = true;
  for (int row = 0; row < 20; ++row) {
    for (int i = 0; i < 12; ++i) {
      const float angle_rad = 0.13F * static_cast<float>(i);
      CloudPoint& p = object.model.points_O.emplace_back();
      p.nx = std::cos(angle_rad);
      p.ny = std::sin(angle_rad);
      p.x = 0.04F * p.nx;
      p.y = 0.04F * p.ny;
      p.z = 0.005F * static_cast<float>(row - 10);
      p.red = 200;
      p.green = static_cast<std::uint8_t>(10 * row);
      p.weight = 3.5F;
    }
  }
  object.model.views_O = {Eigen::Vector3f(1.0F, 2.0F, 0.5F).normalized(),
                          -Eigen::Vector3f::UnitY()};
  object.model.empty_O = EmptySpace({-0.05F, -0.05F, -0.06F}, 0.05F, {2, 2, 3},
                                    {true, false, false, true, true, false,  //
                                     true, true, false, false, false, true});
  object.model.parameters = preset("objects");
  object.model.parameters.scale = 0.0013;
  object.model.times_taught = 2;
  object.wholeness = 0.875;
  object.lessons = {{.map_name = "hall",
                     .map_session = 77,
                     .segment_ids = {12, 34},
                     .time_s = 1'700'000'000,
                     .X_WO = {{0.6, -0.8, 0, 1.25, 0.8, 0.6, 0, -2, 0, 0, 1, 0.1}}},
                    {.map_name = "", .map_session = 0, .segment_ids = {}, .time_s = 0}};
  return object;
}

}  // namespace kintsugi::segmenter::testing
