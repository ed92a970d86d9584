#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {

std::vector<PointIndex> canonical_labels(std::span<const ComponentId> components) {
  constexpr PointIndex kNone = UINT32_MAX;
  std::vector<PointIndex> smallest(components.size(), kNone);
  std::vector<PointIndex> labels(components.size(), kNoComponent);
  for (PointIndex i = 0; i < components.size(); ++i) {
    if (components[i] == kNoComponent) continue;
    PointIndex& label = smallest[components[i]];
    if (label == kNone) label = i;
    labels[i] = label;
  }
  return labels;
}

}  // namespace kintsugi::segmenter
