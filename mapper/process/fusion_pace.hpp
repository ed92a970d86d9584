#pragma once

#include <cstddef>

namespace kintsugi::mapper {

/// Chooses the frames that are only tracked and not fused, where the mapper is slower than the
/// camera: after each fused frame at most as many as wait, so that the map keeps up with what comes
/// into view. Fusion and the raycast after it take a third of a frame's time, and nearly half of
/// its processor time. A frame that is left out of the map costs little, as the next ones show the
/// same; one that is left out of tracking makes the motion to the next one larger.
class FusionPace {
 public:
  /// So many frames of a live source may wait for the mapper: half a second at 30 Hz. More are
  /// dropped: who steers by the poses is not helped by what was seen earlier.
  static constexpr std::size_t kMaxWaiting = 15;

  /// Whether the next frame is fused.
  /// @param num_waiting frames that have come after it
  bool fuses(std::size_t num_waiting);

 private:
  std::size_t num_left_out_ = 0;  ///< frames since the last one that was fused
};

}  // namespace kintsugi::mapper
