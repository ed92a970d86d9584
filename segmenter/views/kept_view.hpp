#pragma once
// A view of the camera that is kept beside the map.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "segmenter/views/map_view.hpp"

namespace kintsugi::segmenter {

/// A view hangs on a patch: where corrections of the map move that, the view goes with it. P is the
/// frame of the patch.
struct KeptView {
  static constexpr std::int32_t kNoPatch = -1;

  std::int64_t utime = 0;         ///< of the frame, device time, microseconds
  Pose X_PC = Pose::Identity();   ///< without a patch: X_WC
  Pose X_WC = Pose::Identity();   ///< where it was when its map was last looked at
  Intrinsics intrinsics;          ///< of the small depth image
  std::int32_t patch = kNoPatch;  ///< CloudSlice::id
  std::int32_t part = 0;          ///< of the map in which the camera was
  /// pack_depth() of the depth, millimetres along C's z. Never null; copies share it.
  std::shared_ptr<const std::vector<std::uint8_t>> packed_depth;
};

/// The views of one map session, by ascending time.
struct ViewSet {
  std::int64_t map_session = 0;  ///< of the mapper
  std::string map_name;
  std::vector<KeptView> views;
};

/// Where a patch is now; nothing: it is not known.
using PlaceOfPatch = std::function<std::optional<PatchPlace>(std::int32_t patch)>;

/// The view as it is in the map now.
/// @throws std::invalid_argument when its depth cannot be unpacked
MapView unpacked(const KeptView& view, const PlaceOfPatch& place_of);

}  // namespace kintsugi::segmenter
