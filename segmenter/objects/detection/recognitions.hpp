#pragma once
// What has been recognised in a map, segment by segment, and which of it holds.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "segmenter/objects/detection/candidates.hpp"
#include "segmenter/objects/detection/labelled_map.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"

namespace kintsugi::segmenter {

/// The best recognition at each segment. It depends on the map alone, not on the order in which
/// segments came and were examined.
class Recognitions {
 public:
  /// `recognizer`, `map` and `access` must outlive this.
  Recognitions(const ObjectRecognizer& recognizer, const LabelledMap& map, const MapAccess& access)
      : recognizer_(recognizer), map_(map), access_(access) {}

  /// Examines the segment and its unions with neighbours again. One that does not exist any more is
  /// forgotten. @return whether something may be recognised there now, or was before
  bool examine(std::uint32_t segment);

  /// The segments at which something was recognised that has one of these as part.
  [[nodiscard]] std::set<std::uint32_t> seeds_of(const std::set<std::uint32_t>& parts) const;

  /// Recognitions that do not contradict each other: where two explain the same surface, the one
  /// of the higher score counts. The highest score first.
  [[nodiscard]] std::vector<Recognition> best() const;

  /// The map has changed: what was computed of these segments does not hold any more.
  void forget(const std::set<std::uint32_t>& changed);

  /// How many candidates were looked at so far.
  [[nodiscard]] std::int64_t num_candidates() const { return num_candidates_; }

 private:
  [[nodiscard]] float largest_box_m() const;
  const std::optional<Recognition>& recognize(const Candidate& candidate);
  const std::vector<SegmentNeighbour>& neighbours_of(std::uint32_t segment);

  const ObjectRecognizer& recognizer_;
  const LabelledMap& map_;
  const MapAccess& access_;
  std::map<std::uint32_t, std::vector<SegmentNeighbour>> neighbours_;
  std::map<std::uint32_t, Recognition> by_segment_;
  /// What was found at each candidate since the map changed: most are those of several segments.
  std::map<Candidate, std::optional<Recognition>> by_candidate_;
  std::int64_t num_candidates_ = 0;
};

}  // namespace kintsugi::segmenter
