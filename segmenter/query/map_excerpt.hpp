#pragma once
// What the answer to a query about few segments needs of a map.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/description/labelled_cloud.hpp"
#include "segmenter/map/last_change.hpp"
#include "segmenter/query/find_segments.hpp"

namespace kintsugi::segmenter {

class SegmentMap;

/// The segments that a query found, and all points that their description depends on.
struct MapExcerpt {
  // Of the whole map, as in SegmentAnswer:
  std::int64_t session = 0;
  std::int64_t map_session = 0;
  std::string map_name;
  std::int32_t map_slices = 0;
  std::int64_t map_points = 0;
  std::int64_t map_segments = 0;

  FoundSegments found;
  std::vector<SegmentStatistics> segments;  ///< those found, by ascending id
  std::vector<LastChange> last_changes;     ///< of each of them

  /// Those within r of the box of one of the segments, in the order of a snapshot of the map.
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;  ///< by point
  float resolution_m = 0.0F;               ///< as in LabelledCloud
  float radius_m = 0.0F;

  LabelledCloud cloud() const { return {points_W, segment_ids, resolution_m, radius_m}; }
};

/// Whether an excerpt is all that the answer needs, and much less than the map: the query is about
/// one point, ray or pixel, about few segments, or about views, which are not in the map.
bool needs_excerpt(const SegmentQuery& query);

/// Takes what needs_excerpt() queries need of a map that is not changing meanwhile, into existing
/// memory. Takes some nanoseconds for each point of the map, and more for those that are copied.
/// @param view as for answer()
/// @throws as find_segments()
void take_excerpt(const SegmentMap& map, const SegmentQuery& query, const CameraView* view,
                  MapExcerpt& excerpt);

}  // namespace kintsugi::segmenter
