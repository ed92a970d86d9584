#include "segmenter/objects/detection/recognitions.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter {

namespace {

/// The best first; of those that have segments in common only the best.
std::vector<Recognition> without_overlap(std::vector<Recognition> all) {
  std::stable_sort(all.begin(), all.end(), [](const Recognition& a, const Recognition& b) {
    return a.placement.score() > b.placement.score();
  });
  std::vector<Recognition> best;
  for (Recognition& recognition : all) {
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const Recognition& other) {
      return share_segments(recognition, other);
    });
    if (is_new) best.push_back(std::move(recognition));
  }
  return best;
}

/// In whatever light: what was followed has been compared with that of then.
std::vector<Recognition> all_of(
    const std::map<std::uint32_t, std::vector<Recognition>>& by_segment) {
  std::vector<Recognition> all;
  for (const auto& [segment, recognitions] : by_segment) {
    all.insert(all.end(), recognitions.begin(), recognitions.end());
  }
  for (Recognition& recognition : all) recognition.placement.light_agreement = 1.0F;
  return all;
}

template <class Work>
void for_each_of(std::size_t count, bool on_all_cores, const Work& work) {
  if (on_all_cores) {
    oneapi::tbb::parallel_for(std::size_t{0}, count, work);
  } else {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
}

}  // namespace

bool share_segments(const Recognition& a, const Recognition& b) {
  const std::vector<std::uint32_t>& ids = b.placement.segment_ids;
  return std::any_of(
      a.placement.segment_ids.begin(), a.placement.segment_ids.end(),
      [&ids](std::uint32_t id) { return std::binary_search(ids.begin(), ids.end(), id); });
}

std::vector<float> Recognitions::least_distances(std::span<const std::uint32_t> segments,
                                                 bool on_all_cores) const {
  std::vector<float> distances(segments.size(), std::numeric_limits<float>::infinity());
  for_each_of(segments.size(), on_all_cores, [&](std::size_t i) {
    for (const Candidate& candidate : candidates_at(segments[i])) {
      distances[i] = std::min(distances[i], recognizer_.least_distance(candidate, scene_));
    }
  });
  return distances;
}

bool Recognitions::examine(std::span<const std::uint32_t> segments) {
  bool was_there = false;
  for (const std::uint32_t segment : segments) was_there |= by_segment_.erase(segment) > 0;
  std::vector<std::vector<Candidate>> candidates(segments.size());
  for_each_of(segments.size(), segments.size() > 1,
              [&](std::size_t i) { candidates[i] = candidates_at(segments[i]); });
  recognize(candidates);
  bool is_there = false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    keep_best(segments[i], candidates[i]);
    is_there |= by_segment_.contains(segments[i]);
  }
  return was_there || is_there;
}

std::vector<Candidate> Recognitions::candidates_at(std::uint32_t segment) const {
  if (scene_.map().num_points(segment) == 0) return {};
  return candidates_of(
      segment, scene_.map(),
      [this](std::uint32_t id) -> const std::vector<SegmentNeighbour>& {
        return scene_.neighbours_of(id);
      },
      largest_box_m());
}

/// Those that are not known yet. Each is a matter of the scene alone, so that the order does not
/// matter.
void Recognitions::recognize(const std::vector<std::vector<Candidate>>& candidates) {
  std::vector<std::pair<const Candidate, std::vector<Recognition>>*> unknown;
  for (const std::vector<Candidate>& of_segment : candidates) {
    for (const Candidate& candidate : of_segment) {
      const auto [at, is_new] = by_candidate_.try_emplace(candidate);
      if (is_new) unknown.push_back(&*at);
    }
  }
  num_candidates_ += std::ssize(unknown);
  for_each_of(unknown.size(), candidates.size() > 1, [&](std::size_t i) {
    unknown[i]->second = recognizer_.recognize(unknown[i]->first, scene_);
  });
}

/// Of each object the best place that has the segment, and the best that has not: where two things
/// alike touch, a union of both is best recognised as one of them, whatever its seed.
void Recognitions::keep_best(std::uint32_t segment, const std::vector<Candidate>& candidates) {
  std::map<std::pair<std::size_t, bool>, const Recognition*> best;  // by model, and has the segment
  for (const Candidate& candidate : candidates) {
    for (const Recognition& found : by_candidate_.at(candidate)) {
      const bool has_segment = std::ranges::binary_search(found.placement.segment_ids, segment);
      const Recognition*& known = best[{found.model, has_segment}];
      if (known == nullptr || found.placement.score() > known->placement.score()) known = &found;
    }
  }
  if (best.empty()) return;
  std::vector<Recognition>& all = by_segment_[segment];
  for (const auto& [key, recognition] : best) all.push_back(*recognition);
}

void Recognitions::set(std::uint32_t segment, Recognition recognition) {
  by_segment_[segment] = {std::move(recognition)};
}

void Recognitions::add(Recognition recognition) {
  std::vector<Recognition>& there = by_segment_[recognition.placement.segment_ids.front()];
  std::erase_if(there, [&](const Recognition& old) { return old.model == recognition.model; });
  there.push_back(std::move(recognition));
}

std::span<const Recognition> Recognitions::at(std::uint32_t segment) const {
  const auto found = by_segment_.find(segment);
  if (found == by_segment_.end()) return {};
  return found->second;
}

std::set<std::uint32_t> Recognitions::seeds_of(const std::set<std::uint32_t>& parts) const {
  std::set<std::uint32_t> seeds;
  const auto is_part = [&parts](std::uint32_t id) { return parts.contains(id); };
  for (const auto& [seed, recognitions] : by_segment_) {
    const bool has_part = std::ranges::any_of(recognitions, [&](const Recognition& recognition) {
      return std::ranges::any_of(recognition.placement.segment_ids, is_part);
    });
    if (has_part) seeds.insert(seed);
  }
  return seeds;
}

bool Recognitions::is_of_this_map(std::size_t model) const {
  return map_session_ != 0 && recognizer_.model(model).map_session == map_session_;
}

SceneLights Recognitions::lights_of_others() const {
  std::vector<Recognition> all = without_overlap(all_of(by_segment_));
  std::erase_if(all, [this](const Recognition& each) { return is_of_this_map(each.model); });
  return SceneLights(std::move(all));
}

SceneLight Recognitions::light_of(std::size_t model, const SceneLights& others) const {
  return is_of_this_map(model) ? SceneLight::known({-scene_.light().log_gain}) : others.of(model);
}

SceneLight Recognitions::light_of(std::size_t model) const {
  return light_of(model, lights_of_others());
}

bool Recognitions::may_tell_light() const {
  std::size_t num_others = 0;
  for (std::size_t model = 0; model < recognizer_.num_models(); ++model) {
    if (!is_of_this_map(model)) ++num_others;
  }
  return num_others >= kFewestThatTellLight;
}

std::optional<LightChange> Recognitions::light() const {
  const SceneLights lights = lights_of_others();
  if (!lights.of_most_objects()) return std::nullopt;
  return LightChange{lights.of_most_objects()->log_gain};
}

void Recognitions::forget_all() {
  by_segment_.clear();
  forget_candidates();
}

void Recognitions::forget_candidates() { by_candidate_.clear(); }

std::vector<Recognition> Recognitions::best() const {
  std::vector<Recognition> all = all_of(by_segment_);
  const SceneLights others = lights_of_others();
  std::map<std::size_t, SceneLight> lights;  // by model
  for (auto& [model, placement, searched_points] : all) {
    const auto [at, is_new] = lights.try_emplace(model);
    if (is_new) at->second = light_of(model, others);
    placement.light_agreement = at->second.agreement(placement.light);
  }
  std::erase_if(all, [](const Recognition& recognition) {
    return recognition.placement.score() < kLeastScore;
  });
  return without_overlap(std::move(all));
}

/// The box along the axes of W of a thing that is turned about the vertical is up to sqrt(2) times
/// as large along both horizontal axes.
float Recognitions::largest_box_m() const {
  return std::numbers::sqrt2_v<float> * 2 * recognizer_.largest_radius_m() +
         2 * scene_.resolution_m();
}

}  // namespace kintsugi::segmenter
