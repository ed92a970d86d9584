#pragma once
// What the files of a map are called.

#include <cstdint>
#include <string>

namespace kintsugi::segmenter {

/// "segments" for the map whose name is `plain_name`, "segments_NAME" for others. NAME comes from
/// the bus: letters, digits, '-' and '_' of it stay, other bytes become %XX, and of a long one the
/// end is replaced by its CRC-32, so that it is always a file name, and another for another name.
std::string map_stem(const std::string& map_name, const std::string& plain_name);

/// The stem of a session that has lost its name to a newer one.
std::string session_stem(const std::string& map_stem, std::int64_t map_session);

}  // namespace kintsugi::segmenter
