#pragma once
// What makes a room a kitchen. X_WG as in furniture.hpp, or as in small_objects.hpp for what stands
// on something.

#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

// Along the wall, as deep and as high as add_counter().
void add_sink_counter(SceneBuilder& builder, const Pose& X_WG, double width);  ///< at least 0.9 m
void add_stove(SceneBuilder& builder, const Pose& X_WG);                       ///< 0.6 m wide

// On the wall, as in room_shell.hpp: G's origin in the middle of the lower edge, on the wall.
void add_wall_cupboard(SceneBuilder& builder, const Pose& X_WG, double width);
void add_extractor_hood(SceneBuilder& builder, const Pose& X_WG);

void add_toaster(SceneBuilder& builder, const Pose& X_WG);
void add_plate(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_chopping_board(SceneBuilder& builder, const Pose& X_WG);  ///< with a loaf of bread on it
void add_paper_roll(SceneBuilder& builder, const Pose& X_WG);
void add_dish_rack(SceneBuilder& builder, const Pose& X_WG);  ///< with plates in it

}  // namespace kintsugi::synthetic
