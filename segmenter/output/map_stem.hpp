#pragma once
// Names of the map files.

#include <cstdint>
#include <string>

namespace kintsugi::segmenter {

/// "segments" for the map called `plain_name`, "segments_NAME" for others. NAME comes from the bus,
/// so it is made a valid and unique file name: letters, digits, '-' and '_' stay, other bytes
/// become %XX, and the end of a long name is replaced by the CRC-32 of the name.
std::string map_stem(const std::string& map_name, const std::string& plain_name);

/// The stem for a superseded session, whose map name belongs to a newer session.
std::string session_stem(const std::string& map_stem, std::int64_t map_session);

}  // namespace kintsugi::segmenter
