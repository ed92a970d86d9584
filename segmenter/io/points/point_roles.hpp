#pragma once
// What the columns of a table mean.

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// Indices of the columns that are used.
struct PointRoles {
  using Triple = std::array<std::size_t, 3>;

  Triple position{};
  std::optional<Triple> normal;
  std::optional<Triple> color;
  std::optional<std::size_t> weight;
  std::optional<std::size_t> slice_id;
  std::optional<std::size_t> segment_id;
  std::optional<std::size_t> instance_id;
  std::optional<std::size_t> in_volume;
};

/// Whether the labels of a cloud (segment_id, instance_id, in_volume) are wanted or pass unread.
enum class LabelUse { kRead, kIgnore };

/// Finds columns by their names: x y z (float or double; required), nx ny nz (float or double),
/// red green blue, diffuse_red diffuse_green diffuse_blue or r g b (uchar, ushort, or float in
/// 0..1), weight (any type), slice_id, segment_id, instance_id and in_volume (any integer type).
///
/// @param name of the file, for errors
/// @throws std::runtime_error with the file, the place of the declaration, and what is missing or
///   of another type
PointRoles find_roles(const PointTable& table, const std::string& name,
                      LabelUse labels = LabelUse::kRead);

}  // namespace kintsugi::segmenter
