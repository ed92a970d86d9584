#include "segmenter/views/kept_view.hpp"

#include <cstddef>

#include "segmenter/views/packed_depth.hpp"

namespace kintsugi::segmenter {

MapView unpacked(const KeptView& view, const PlaceOfPatch& place_of) {
  MapView result;
  result.utime = view.utime;
  result.X_WC = view.X_WC;
  result.intrinsics = view.intrinsics;
  result.depth_mm =
      unpack_depth(*view.packed_depth, static_cast<std::size_t>(view.intrinsics.width),
                   static_cast<std::size_t>(view.intrinsics.height));
  if (view.patch != KeptView::kNoPatch) {
    if (const auto place = place_of(view.patch)) result.X_WC = place->X_WP.pose() * view.X_PC;
  }
  return result;
}

}  // namespace kintsugi::segmenter
