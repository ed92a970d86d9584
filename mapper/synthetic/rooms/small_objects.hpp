#pragma once
// Things that stand on a table or a shelf. X_WG is the place of the object's own frame G: its
// origin in the middle of the footprint, z up, the object's front towards -y. Metres.

#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

void add_monitor(SceneBuilder& builder, const Pose& X_WG);
void add_laptop(SceneBuilder& builder, const Pose& X_WG);
void add_keyboard(SceneBuilder& builder, const Pose& X_WG);
void add_mouse(SceneBuilder& builder, const Pose& X_WG);
void add_phone(SceneBuilder& builder, const Pose& X_WG);
void add_speaker(SceneBuilder& builder, const Pose& X_WG);
void add_desk_lamp(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_mug(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_bowl(SceneBuilder& builder, const Pose& X_WG, const Color& color);  ///< with fruit in it
void add_bottle(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_teapot(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_cooking_pot(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_pen_holder(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_plant(SceneBuilder& builder, const Pose& X_WG, double size);  ///< height about 1.0 size
void add_globe(SceneBuilder& builder, const Pose& X_WG);
void add_vase(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_tape_roll(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_carton(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& size_m);
void add_ball(SceneBuilder& builder, const Pose& X_WG, double radius, const Color& color);

/// One closed book that lies flat, its spine towards -y.
void add_book(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& size_m,
              const Color& color);

/// Books on top of each other, each a little turned.
void add_book_stack(SceneBuilder& builder, const Pose& X_WG, int count, CounterRandom& random);

/// Books that stand side by side along x and fill `width_m`; the last one leans on the others.
void add_book_row(SceneBuilder& builder, const Pose& X_WG, double width_m, double max_height_m,
                  CounterRandom& random);

/// One of the above, drawn at random, that fits into a cube of 0.3 m.
void add_any_small_object(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random);

/// A strong colour, drawn at random from a fixed palette.
Color any_color(CounterRandom& random);

}  // namespace kintsugi::synthetic
