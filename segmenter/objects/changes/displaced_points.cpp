#include "segmenter/objects/changes/displaced_points.hpp"

#include <cstddef>
#include <cstdint>
#include <map>

#include "segmenter/objects/changes/filled_space.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kLeastOfSegment = 0.25;  // less is what rooms are larger than things

}  // namespace

void mark_displaced(const MapSide& map, std::vector<PointChange>& changes, const MapSide& other,
                    std::span<const ChangeGroup> other_groups, const Eigen::Vector3d& up,
                    const MapErrors& errors) {
  const auto margin_m = static_cast<float>(errors.distance_m);
  for (const ChangeGroup& group : other_groups) {
    if (!group.is_thing) continue;
    const FilledSpace room(other.points_at(group.points), up);
    std::map<std::uint32_t, std::vector<std::size_t>> displaced;  // by segment
    for (std::size_t i = 0; i < changes.size(); ++i) {
      if (changes[i] != PointChange::kUnknown || map.segment_ids()[i] == 0) continue;
      if (room.contains(position_of(map.points()[i]), margin_m)) {
        displaced[map.segment_ids()[i]].push_back(i);
      }
    }
    for (const auto& [id, points] : displaced) {
      const std::vector<std::size_t>& segment = map.points_of(id);
      const double least = kLeastOfSegment * static_cast<double>(segment.size());
      if (static_cast<double>(points.size()) < least) continue;
      for (const std::size_t i : segment) {
        if (changes[i] == PointChange::kUnknown) changes[i] = PointChange::kChanged;
      }
    }
  }
}

}  // namespace kintsugi::segmenter
