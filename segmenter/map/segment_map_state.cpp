#include "segmenter/map/segment_map_state.hpp"

#include "segmenter/core/make_engine.hpp"

namespace kintsugi::segmenter {

void SegmentMapConfig::validate() const { check_mode(mode, engine); }

}  // namespace kintsugi::segmenter
