#pragma once
// Of several maps the one that a query means.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// What tells maps apart.
struct MapIdentity {
  std::int64_t map_session = 0;  ///< of the mapper
  std::string map_name;
};

/// The place in `maps` of the one that `query` asks: that of its session, or else the newest of its
/// name; where it gives neither, the newest, provided that all have one name.
/// @throws std::invalid_argument with a text for whoever asked when there is no such map, or a name
///   is needed; it names the maps there are
std::size_t choose_map(std::span<const MapIdentity> maps, const SegmentQuery& query);

}  // namespace kintsugi::segmenter
