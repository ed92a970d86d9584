#pragma once
// What kintsugi-diff wrote.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A change that shows an object. In the map in which it was seen last: the one after, or, if it is
/// gone, the one before.
struct ShownChange {
  std::int64_t id = 0;
  std::string kind;                        ///< "new", "gone" or "moved"
  std::vector<CloudPoint> points_W;        ///< of the object there
  std::vector<std::uint32_t> segment_ids;  ///< of that map, ascending
  Pose X_WA = Pose::Identity();            ///< of the W of the map after in that of `map`
  std::filesystem::path map;
  std::int64_t map_session = 0;  ///< of that map, as it was compared; 0: not known
};

/// Reads changes.json and change_ID.ply of `folder`: the change with that id, or all of the three
/// kinds.
/// @param map_after where the map after is saved; empty: changes.json tells
/// @throws std::runtime_error naming the file, the place and the reason; the ids there are, if
///   there is none with `id`
std::vector<ShownChange> read_changes(const std::filesystem::path& folder,
                                      std::optional<std::int64_t> id,
                                      const std::filesystem::path& map_after = {});

}  // namespace kintsugi::segmenter
