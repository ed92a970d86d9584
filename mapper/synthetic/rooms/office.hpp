#pragma once
// The furnished office, before anybody changes it, and places in it.

#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

/// The room and all that is in the scene "office".
void add_office(SceneBuilder& builder);

/// T: the middle of the desk's top; x along the desk, y towards the wall.
Pose office_desk_top();
/// G of the bookcase; its boards are at on_board().
Pose office_bookcase();
inline constexpr double kOfficeBackWall_m = 1.8;  ///< y of the wall behind the desk

Color office_wall_color();
Material office_carpet();

}  // namespace kintsugi::synthetic
