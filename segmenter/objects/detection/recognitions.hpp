#pragma once
// What has been recognised in a map, segment by segment, and which of it holds.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "segmenter/objects/detection/candidates.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"
#include "segmenter/objects/recognition/scene_light.hpp"

namespace kintsugi::segmenter {

/// They explain the same surface, at least in part.
bool share_segments(const Recognition& a, const Recognition& b);

/// What each segment may be. It depends on the map alone, not on the order in which
/// segments came and were examined.
class Recognitions {
 public:
  /// `recognizer` and `scene` must outlive this.
  /// @param map_session of the scene; 0: not known
  Recognitions(const ObjectRecognizer& recognizer, const Scene& scene, std::int64_t map_session)
      : recognizer_(recognizer), scene_(scene), map_session_(map_session) {}

  /// How unlike all objects a segment and its unions with neighbours are, of each of these
  /// segments: the least of ObjectRecognizer::least_distance().
  [[nodiscard]] std::vector<float> least_distances(std::span<const std::uint32_t> segments,
                                                   bool on_all_cores) const;

  /// Examines segments and their unions with neighbours again: one on this thread, several on all
  /// cores. One that does not exist any more is forgotten.
  /// @return whether something may be recognised there now, or was before
  bool examine(std::span<const std::uint32_t> segments);

  /// What is recognised at a segment, instead of all that was.
  void set(std::uint32_t segment, Recognition recognition);

  /// Something that was recognised otherwise: it counts until the first of its segments is examined
  /// again, instead of what the same object was recognised as there.
  void add(Recognition recognition);

  /// What was recognised at a segment.
  [[nodiscard]] std::span<const Recognition> at(std::uint32_t segment) const;
  /// The segments of which what was recognised has one of these as part.
  [[nodiscard]] std::set<std::uint32_t> seeds_of(const std::set<std::uint32_t>& parts) const;

  /// Recognitions that do not contradict each other: where two explain the same surface, the one
  /// of the higher score counts. The highest score first.
  [[nodiscard]] std::vector<Recognition> best() const;

  /// The light of the map as it falls on an object, beside that of the scene (Scene::set_light()),
  /// as best() has it: where it was taught in this map, it is as it was then.
  [[nodiscard]] SceneLight light_of(std::size_t model) const;
  /// There are enough objects of other maps to tell the light.
  [[nodiscard]] bool may_tell_light() const;
  /// How it differs from that of the scene for objects of other maps, as far as what is recognised
  /// tells; nothing: too little is.
  [[nodiscard]] std::optional<LightChange> light() const;

  /// All of the scene looks different.
  void forget_all();
  /// The map has changed: what was found at candidates does not hold any more.
  void forget_candidates();

  /// How many candidates were looked at so far.
  [[nodiscard]] std::int64_t num_candidates() const { return num_candidates_; }

 private:
  [[nodiscard]] bool is_of_this_map(std::size_t model) const;
  [[nodiscard]] SceneLights lights_of_others() const;
  [[nodiscard]] SceneLight light_of(std::size_t model, const SceneLights& others) const;
  [[nodiscard]] float largest_box_m() const;
  [[nodiscard]] std::vector<Candidate> candidates_at(std::uint32_t segment) const;
  void recognize(const std::vector<std::vector<Candidate>>& candidates);
  void keep_best(std::uint32_t segment, const std::vector<Candidate>& candidates);

  const ObjectRecognizer& recognizer_;
  const Scene& scene_;
  std::int64_t map_session_;
  std::map<std::uint32_t, std::vector<Recognition>> by_segment_;  // what keep_best() kept
  /// What was found at each candidate since the map changed: most are those of several segments.
  std::map<Candidate, std::vector<Recognition>> by_candidate_;
  std::int64_t num_candidates_ = 0;
};

}  // namespace kintsugi::segmenter
