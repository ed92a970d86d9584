#include "segmenter/query/choose_map.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>

namespace kintsugi::segmenter {
namespace {

std::string listed(std::span<const MapIdentity> maps) {
  if (maps.empty()) return "no map is kept yet";
  std::string text;
  for (const MapIdentity& map : maps) {
    text += (text.empty() ? "" : ", ") + ("'" + map.map_name + "' of session ") +
            std::to_string(map.map_session);
  }
  return "there is " + text;
}

[[noreturn]] void refuse(const std::string& what, std::span<const MapIdentity> maps) {
  throw std::invalid_argument(what + listed(maps));
}

}  // namespace

std::size_t choose_map(std::span<const MapIdentity> maps, const SegmentQuery& query) {
  std::optional<std::size_t> chosen;
  std::set<std::string> names;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const MapIdentity& map = maps[i];
    const bool fits_session = query.map_session == 0 || map.map_session == query.map_session;
    const bool fits_name = query.map_name.empty() || map.map_name == query.map_name;
    if (!fits_session || !fits_name) continue;
    names.insert(map.map_name);
    if (!chosen || map.map_session > maps[*chosen].map_session) chosen = i;
  }
  if (names.size() > 1) refuse("several maps are kept, name one: ", maps);
  if (chosen) return *chosen;
  if (query.map_session != 0) {
    refuse("no map of session " + std::to_string(query.map_session) + ": ", maps);
  }
  refuse(query.map_name.empty() ? "" : "no map '" + query.map_name + "': ", maps);
}

}  // namespace kintsugi::segmenter
