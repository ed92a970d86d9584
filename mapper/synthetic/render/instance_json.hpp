#pragma once
// Poses and symmetries of instances as JSON.

#include <nlohmann/json_fwd.hpp>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// 12 numbers: the rows of the 3 x 4 matrix [R t].
nlohmann::ordered_json numbers_of(const Pose& pose);

/// {"centre_G": [3], "axes": [{"direction_G": [3], "order": 2}]}; order 0: by any angle. See
/// symmetry_of().
nlohmann::ordered_json symmetry_json(const Instance& instance, const Scene& scene);

}  // namespace kintsugi::synthetic
