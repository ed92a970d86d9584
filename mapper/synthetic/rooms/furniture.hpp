#pragma once
// Things that stand on the floor. X_WG is the place of the object's own frame G: its origin on the
// floor in the middle of the footprint, z up, the object's front towards -y. Metres.

#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

inline constexpr double kDeskHeight_m = 0.74;
inline constexpr double kCounterHeight_m = 0.90;
inline constexpr double kTableHeight_m = 0.72;
inline constexpr double kCabinetHeight_m = 0.80;

/// The wood of desks and bookcases: what else is made of it differs from them by its shape alone.
Material oak();

void add_desk(SceneBuilder& builder, const Pose& X_WG, double width, double depth);
void add_table(SceneBuilder& builder, const Pose& X_WG, double width, double depth);
void add_round_table(SceneBuilder& builder, const Pose& X_WG, double radius, double height);
void add_office_chair(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_chair(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_stool(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_sofa(SceneBuilder& builder, const Pose& X_WG, double width, const Color& color);
void add_bed(SceneBuilder& builder, const Pose& X_WG, const Color& color);  ///< 1.0 x 2.0 m
void add_cabinet(SceneBuilder& builder, const Pose& X_WG, double width, const Color& color);
void add_counter(SceneBuilder& builder, const Pose& X_WG, double width);
void add_fridge(SceneBuilder& builder, const Pose& X_WG);
void add_bench(SceneBuilder& builder, const Pose& X_WG, double width);
void add_bin(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_floor_lamp(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_coat_rack(SceneBuilder& builder, const Pose& X_WG);
void add_backpack(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_traffic_cone(SceneBuilder& builder, const Pose& X_WG);

/// An empty bookcase, 0.28 m deep, with a board every 0.36 m. Returns their number.
int add_bookcase_frame(SceneBuilder& builder, const Pose& X_WG, double width, double height);

/// X_GB: on its board i, counted from below, in the middle.
Pose on_board(int i);

/// Boards every 0.36 m with books and small objects on them; 0.28 m deep.
void add_bookcase(SceneBuilder& builder, const Pose& X_WG, double width, double height,
                  CounterRandom& random);

}  // namespace kintsugi::synthetic
