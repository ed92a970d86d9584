#include "segmenter/objects/detection/candidates.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace kintsugi::segmenter {

namespace {

bool contains(const Candidate& candidate, std::uint32_t id) {
  return std::find(candidate.begin(), candidate.end(), id) != candidate.end();
}

class Growth {
 public:
  Growth(std::uint32_t segment, const LabelledMap& map, const NeighboursOf& neighbours_of,
         float largest_m)
      : map_(map),
        neighbours_of_(neighbours_of),
        largest_m_(largest_m),
        ids_{segment},
        box_(map.box_of(segment)),
        count_(map.num_points(segment)) {}

  /// Adds the neighbour with the longest common border that fits. @return false if there is none
  bool grow(bool only_smaller) {
    std::map<std::uint32_t, std::int64_t> pairs;
    for (const std::uint32_t id : ids_) {
      for (const SegmentNeighbour& neighbour : neighbours_of_(id)) {
        if (!contains(ids_, neighbour.segment_id)) {
          pairs[neighbour.segment_id] += neighbour.num_pairs;
        }
      }
    }
    std::optional<std::uint32_t> best;
    for (const auto& [id, count] : pairs) {
      if (best && count <= pairs[*best]) continue;
      if (map_.num_points(id) == 0) continue;  // it was there when the neighbours were found
      if (only_smaller && map_.num_points(id) > count_) continue;
      if (box_.merged(map_.box_of(id)).diagonal().norm() > largest_m_) continue;
      best = id;
    }
    if (!best) return false;
    ids_.push_back(*best);
    box_.extend(map_.box_of(*best));
    count_ += map_.num_points(*best);
    return true;
  }

  [[nodiscard]] Candidate candidate() const {
    Candidate sorted = ids_;
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

 private:
  const LabelledMap& map_;
  const NeighboursOf& neighbours_of_;
  float largest_m_;
  Candidate ids_;  // in the order in which they were added
  Eigen::AlignedBox3f box_;
  std::int64_t count_;
};

}  // namespace

std::vector<Candidate> candidates_of(std::uint32_t segment, const LabelledMap& map,
                                     const NeighboursOf& neighbours_of, float largest_m) {
  const Eigen::AlignedBox3f box = map.box_of(segment);
  if (box.isEmpty() || box.diagonal().norm() > largest_m) return {};
  std::vector<Candidate> candidates{{segment}};
  for (const bool only_smaller : {false, true}) {
    Growth growth(segment, map, neighbours_of, largest_m);
    for (std::size_t size = 2; size <= kCandidateSegments && growth.grow(only_smaller); ++size) {
      Candidate candidate = growth.candidate();
      if (std::find(candidates.begin(), candidates.end(), candidate) == candidates.end()) {
        candidates.push_back(std::move(candidate));
      }
    }
  }
  return candidates;
}

}  // namespace kintsugi::segmenter
