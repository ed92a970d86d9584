#pragma once
// A small session whose instances are known, for tests.

#include "segmenter/evaluation/quality/ground_truth.hpp"
#include "segmenter/evaluation/session/recorded_session.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter::testing {

inline constexpr float kResolution_m = 0.01F;
inline constexpr int kSide = 20;  // points along an edge of a sheet

/// Two sheets of 400 points, a floor and a wall beside it; far apart from them a box top.
struct Room {
  RecordedSession session;
  Truth truth;
};

inline void add_sheet(double x_m, bool is_upright, std::uint32_t instance, CloudSlice& slice,
                      Truth& truth) {
  for (int i = 0; i < kSide * kSide; ++i) {
    const double u = kResolution_m * (i % kSide);
    const int row = i / kSide;
    const double v = kResolution_m * (row + 1);
    slice.points_W.push_back(is_upright ? make_point(x_m, u, v, 1, 0, 0)
                                        : make_point(x_m + v, u, 0, 0, 0, 1));
    truth.points_W.push_back(slice.points_W.back());
    truth.instance_ids.push_back(instance);
  }
}

inline Room make_room() {
  Room room;
  room.session.source = "room.lcm";
  for (int i = 0; i < 2; ++i) {
    room.session.steps.emplace_back().slices.emplace_back();
    room.session.steps.back().slices[0].id = i;
    room.session.steps.back().slices[0].resolution_m = kResolution_m;
  }
  room.session.num_slices = 2;
  add_sheet(0.0, false, 5, room.session.steps[0].slices[0], room.truth);
  add_sheet(0.0, true, 6, room.session.steps[1].slices[0], room.truth);
  add_sheet(1.0, false, 7, room.session.steps[1].slices[0], room.truth);
  room.truth.instances = {{5, false, "floor"}, {6, false, "wall"}, {7, true, "box"}};
  return room;
}

}  // namespace kintsugi::segmenter::testing
