#pragma once
// Whether two maps that lie one on the other are maps of one place.

#include <vector>

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/maps/refine_alignment.hpp"
#include "segmenter/views/observed_map.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// A map, prepared to be compared with others.
struct ComparedMap {
  explicit ComparedMap(const ObservedMap& map);

  std::vector<CloudPoint> samples;  ///< the surface, coarsely: what is judged
  ReferenceSurface surface;         ///< and finely: what it is judged by
  ObservedSpace space;
};

/// How one map's surface is found in another map.
struct Support {
  double found = 0.0;         ///< share of the samples where the other map has surface, too
  double contradicted = 0.0;  ///< share where the other map has none, and has seen free space
};

struct MapAgreement {
  Support of_before;
  Support of_after;
  /// Correlation of the colours where both maps have surface, after a gain and an offset of each
  /// channel, -1 to 1; 0 where too few have colour.
  double color = 0.0;

  [[nodiscard]] double overlap() const;    ///< of the map of which more is found
  [[nodiscard]] double agreement() const;  ///< found among found and contradicted, of both maps
  /// What hypotheses are compared by: overlap, agreement and colour in one number.
  [[nodiscard]] double score() const;
};

MapAgreement compare(const ComparedMap& before, const ComparedMap& after, const Pose& X_AB);

}  // namespace kintsugi::segmenter
