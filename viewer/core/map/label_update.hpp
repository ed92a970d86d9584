#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Names one version of the points of a slice.
struct SliceKey {
  std::int32_t id = 0;
  std::int32_t revision = 0;

  bool operator<(const SliceKey& other) const {
    return std::tie(id, revision) < std::tie(other.id, other.revision);
  }
};

/// The labels of all points of a slice, with the sequence number of the update they came in.
struct NumberedLabels {
  std::vector<std::uint32_t> labels;
  std::uint32_t number = 0;
};

/// One label for a range of points, with the sequence number of the update it came in.
struct NumberedRun {
  LabelRun run;
  std::uint32_t number = 0;
};

/// What labels or a run did to the map.
enum class UpdateEffect {
  kNotUsable,  ///< they do not fit the slice, or cannot be kept until it arrives: nothing changed
  kNothingNew,
  kChanged,
};

}  // namespace kintsugi::viewer
