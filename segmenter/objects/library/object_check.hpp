#pragma once
// What must hold for every object of a library, whoever made it.

#include <cstddef>

#include "segmenter/objects/library/known_object.hpp"

namespace kintsugi::segmenter {

/// A wall of 5 m x 10 m at 5 mm has as many; an object is smaller.
inline constexpr std::size_t kMaxObjectPoints = std::size_t{1} << 21U;
/// Directions 1.7 degrees apart are about as many, all around.
inline constexpr std::size_t kMaxObjectViews = std::size_t{1} << 14U;
/// An object is so many voxels from its origin at most, along each axis: then 16 bits are enough
/// for a voxel's index.
inline constexpr float kMaxObjectVoxels = 32'000.0F;
/// Half the diagonal of an object's box. A detector compares all unions of segments that are not
/// larger than the largest object: with one stray point, or a whole room, it would find no time for
/// anything else.
inline constexpr float kMaxObjectRadius_m = 5.0F;

/// @throws std::runtime_error naming the field or the point, its value and what was expected
void check_object(const KnownObject& object);

}  // namespace kintsugi::segmenter
