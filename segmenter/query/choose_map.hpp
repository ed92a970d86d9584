#pragma once
// Which of several maps a query asks.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// What distinguishes maps.
struct MapIdentity {
  std::int64_t map_session = 0;  ///< of the mapper
  std::string map_name;
};

/// The index in `maps` of the one that `query` asks: the one of its session, or else the newest one
/// of its name. If it has neither, the newest map, provided that all have the same name.
/// @throws std::invalid_argument with a text for the client, which names the existing maps, when
///   there is no such map, or a name is needed
std::size_t choose_map(std::span<const MapIdentity> maps, const SegmentQuery& query);

}  // namespace kintsugi::segmenter
