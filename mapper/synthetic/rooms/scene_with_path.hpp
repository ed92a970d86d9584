#pragma once

#include "mapper/synthetic/rooms/trajectory.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// A scene and the path of a hand-held camera through it.
struct SceneWithPath {
  Scene scene;
  Trajectory trajectory;
};

}  // namespace kintsugi::synthetic
