#pragma once
// Changes between two maps, as files.

#include <cstdint>
#include <filesystem>
#include <string>

#include "segmenter/objects/changes/map_changes.hpp"
#include "segmenter/objects/maps/align_maps.hpp"

namespace kintsugi::segmenter {

/// Two maps, what puts one on the other, and what differs.
struct MapDifference {
  std::string before;  ///< where it was read; of a map on the bus, its name
  std::string after;
  std::int64_t before_session = 0;  ///< of the mapper
  std::int64_t after_session = 0;
  MapAlignment alignment;
  MapChanges changes;
};

/// changes.json: metres, in AFTER's W; the keys are described in segmenter/README.md.
std::string changes_json(const MapDifference& difference);

/// Writes changes.json, change_ID.ply for each change and changes.png into the folder, which is
/// made where it is absent; change_*.ply of an earlier run are removed. changes.json comes last:
/// who finds it has the others, too.
/// @throws std::runtime_error naming the file and the reason
void write_changes(const MapDifference& difference, const ObservedMap& after,
                   const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
