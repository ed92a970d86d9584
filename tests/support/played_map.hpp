#pragma once
// A generated map, in the slices that a mapper would publish.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::testing {

/// Slices and points per second as a mapper publishes them in real time: `kintsugi-mapper --device
/// synthetic://loop` made 82 slices with 846,082 points in 105 s, and of the first 1,000 frames
/// (33 s) of a 7-Scenes recording 29 with 241,762.
inline constexpr double kNormalSlicesPerSecond = 0.8;
inline constexpr std::size_t kNormalSlicePoints = 10'000;

/// The slices of one session. The last one is the final one.
class PlayedMap {
 public:
  struct Config {
    std::int64_t session = 1;  ///< > 0
    std::string map_name = "map";
    std::size_t num_points = 4'000'000;             ///< at least so many, >= 1
    std::size_t slice_points = kNormalSlicePoints;  ///< of a slice, at least
    std::size_t most_points = 0;                    ///< of a slice, at most; 0: no limit
    int num_rooms = 14;
    std::uint32_t seed = 1;
  };

  /// Generates the map: 4 million points take seconds.
  explicit PlayedMap(const Config& config);

  std::int32_t num_slices() const { return static_cast<std::int32_t>(slices_.size()); }

  /// Slice `id` as published for the `revision`-th time. Every other revision lies a centimetre
  /// off, so that a correction changes something and the next one takes it back.
  CloudSlice slice(std::int32_t id, std::int32_t revision = 0) const;

 private:
  const Config config_;
  std::vector<std::vector<CloudPoint>> slices_;
};

}  // namespace kintsugi::testing
