#pragma once
// Which segments are at the place of a query.

#include <cstdint>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/description/labelled_cloud.hpp"

namespace kintsugi::segmenter {

/// What is at the place of a query.
struct FoundSegments {
  std::vector<std::uint32_t> ids;  ///< some may not exist when the query gives ids
  /// Of QueryPlace::kPoint, kRay and kPixel, as in SegmentAnswer:
  bool has_hit = false;
  float hit_W[3] = {};
  float distance_m = 0.0F;  ///< DescribedSegment::distance_m
  std::int64_t view_utime = 0;
  float surface_distance_m = 0.0F;
};

/// Finds the segments at the place of `query`, which is not kAnywhere.
/// @param view what the camera of the map sees now, for kPixel; null: not known
/// @throws std::invalid_argument with a text for the client when the pixel is outside the image
FoundSegments find_segments(const LabelledCloud& cloud, const SegmentQuery& query,
                            const CameraView* view);

}  // namespace kintsugi::segmenter
