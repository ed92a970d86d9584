#pragma once
// An object of the library: what it looks like, and where that is known from.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/model/object_model.hpp"

namespace kintsugi::segmenter {

/// One occasion on which an object was taught.
struct Lesson {
  std::string map_name;                    ///< of the mapper; empty: not known
  std::int64_t map_session = 0;            ///< of the mapper; 0: not known
  std::vector<std::uint32_t> segment_ids;  ///< in that map, ascending
  std::int64_t time_s = 0;                 ///< when it was taught: seconds since 1970, UTC
  /// Where it stood in that map: rows of the 3 x 4 matrix; nothing: not known.
  std::optional<std::array<double, 12>> X_WO{};

  bool operator==(const Lesson&) const = default;
};

std::array<double, 12> rows_of(const Pose& pose);
/// The inverse.
Pose pose_of(const std::array<double, 12>& rows);

struct KnownObject {
  ObjectModel model;
  /// How whole it comes out of the map with model.parameters: points in both the object and the
  /// segment that is most like it, as a share of those in one of the two; 0 to 1.
  double wholeness = 0.0;
  std::vector<Lesson> lessons;  ///< in the order in which they were taught
};

}  // namespace kintsugi::segmenter
