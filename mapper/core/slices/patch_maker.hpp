#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/slices/patch_batch.hpp"
#include "mapper/core/slices/tile.hpp"

namespace kintsugi::mapper {

/// Makes the patches of a map: numbers them, counts their revisions, and keeps the surface that has
/// left the volume until the last of its tile has left.
///
/// A patch has the surface of its tile that has left, as it was extracted when it left, and then
/// that which is in the volume. So the last revisions of all patches together are the slices that
/// left the volume, point for point. When the volume comes back to a tile that had left it for
/// good, there is another patch.
class PatchMaker {
 public:
  explicit PatchMaker(const TileGrid& grid) : grid_(grid) {}

  /// Takes surface that has left the volume.
  void keep(const ExtractedSurface& left);

  /// The patches of a batch; `in_volume` has the surface of their tiles that is in the volume.
  /// `header` has the fields that are the same in all of them. A patch that never had points is
  /// left out.
  std::vector<CloudSlice> make(const PatchBatch& batch, const ExtractedSurface& in_volume,
                               const CloudSlice& header);

  /// The last revision of every patch that is not departed, and the final slice.
  std::vector<CloudSlice> finish(const CloudSlice& header);

 private:
  static constexpr std::int32_t kNoId = -1;
  struct Patch {
    std::int32_t id = kNoId;
    std::int32_t revision = -1;
    std::vector<CloudPoint> left_W;  ///< points that have left the volume
  };

  std::map<TileCoord, std::vector<CloudPoint>> by_tile(const ExtractedSurface& surface) const;

  const TileGrid grid_;
  std::map<TileCoord, Patch> patches_;  ///< those that may be sent again
  std::int32_t next_id_ = 0;
  std::int64_t revision_sum_ = 0;  ///< of the newest revisions
};

}  // namespace kintsugi::mapper
