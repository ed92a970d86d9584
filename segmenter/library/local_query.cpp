#include "segmenter/library/local_query.hpp"

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::segmenter {

void check_local(const SegmentQuery& query) {
  SegmentQuery sent = query;
  sent.client = 1;     // the bus wants one
  (void)encode(sent);  // checks every field as the bus does
  require(query.place != QueryPlace::kPixel,
          "a query for a pixel needs the camera of a running mapper; this map has none");
  require(query.place != QueryPlace::kViews,
          "a query for views needs a running segmenter; those of a saved map are beside it");
}

}  // namespace kintsugi::segmenter
