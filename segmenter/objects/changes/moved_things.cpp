#include "segmenter/objects/changes/moved_things.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/changes/alike_colors.hpp"
#include "segmenter/objects/changes/motion_evidence.hpp"
#include "segmenter/objects/changes/upright_motion.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/model/object_views.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kSlack_vox = 3.0;   // of sizes: of both grids, and of edges
constexpr double kMostLarger = 1.3;  // a part of which more is seen than of the whole
constexpr std::size_t kColorSamples = 60;
constexpr double kLeastAlikeColors = 0.5;
// As far as the recogniser's poses, and things that were pushed aside a little, are off.
constexpr double kReach_vox = 6.0;
constexpr int kRounds = 3;  // of adding segments and refining
// At the right motion all agree but for edges and noise, which are a tenth.
constexpr double kLeastScore = 0.9;
constexpr double kLeastBegin = 0.6;  // before what moves with it is added
// Of the side of which less is known: the rest of it is hidden where the thing was or is.
constexpr double kLeastFound = 0.7;
// Of the other: a small part of a thing, a flat one above all, is found on many things.
constexpr double kLeastFoundOfBoth = 0.3;
constexpr double kBetterThanBefore = 0.05;
constexpr double kMostShared = 0.2;
constexpr double kLeastOfWhole = 0.5;

/// The things of one map that may have moved, and a recogniser that knows them.
class Candidates {
 public:
  Candidates(const ChangedSide& side, const Eigen::Vector3d& up) {
    for (const ChangeGroup& group : side.groups) {
      Thing thing = thing_of(group, side.map);
      // A trace that is at the rim of something large, as of a table, is not of a thing.
      if (!group.is_thing && thing.segments.empty()) continue;
      const bool is_known = std::ranges::any_of(
          things_, [&](const Thing& other) { return other.points == thing.points; });
      if (!is_known) things_.push_back(std::move(thing));
    }
    std::vector<ObjectModel> models;
    models.reserve(things_.size());
    for (const Thing& thing : things_) {
      points_.push_back(side.map.points_at(thing.points));
      sizes_.push_back(size_of(points_.back(), up));
      MadeModel made = make_model(std::to_string(models.size()), points_.back(),
                                  static_cast<float>(side.map.voxel_m()), up);
      made.model.views_O =
          directions_of_views(made.model.points_O, made.X_WO, side.map.space().views(),
                              static_cast<float>(side.map.voxel_m()));
      models.push_back(std::move(made.model));
      places_.push_back(made.X_WO);
    }
    recognizer_ = std::make_unique<ObjectRecognizer>(std::move(models),
                                                     static_cast<float>(side.map.voxel_m()));
  }

  [[nodiscard]] std::size_t size() const { return things_.size(); }
  [[nodiscard]] const Thing& thing(std::size_t i) const { return things_[i]; }
  [[nodiscard]] const std::vector<CloudPoint>& points(std::size_t i) const { return points_[i]; }
  [[nodiscard]] const Eigen::Vector3d& size_m(std::size_t i) const { return sizes_[i]; }

  /// How the thing would have moved to be what `there` is in the other map.
  [[nodiscard]] std::optional<Pose> motion_to(std::size_t i, std::span<const CloudPoint> there,
                                              const Scene& other) const {
    const auto placement = recognizer_->place(i, thinned(there, other.resolution_m()), other);
    if (!placement) return std::nullopt;
    return placement->X_WO * places_[i].inverse(Eigen::Isometry);
  }

 private:
  std::vector<Thing> things_;
  std::vector<std::vector<CloudPoint>> points_;  // of each thing
  std::vector<Eigen::Vector3d> sizes_;
  std::vector<Pose> places_;  // of the models
  std::unique_ptr<ObjectRecognizer> recognizer_;
};

/// Whether one is as large as the other or a part of it, as what is seen of a thing often is.
bool may_be_of_size(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double slack_m) {
  const auto fits = [slack_m](const Eigen::Vector3d& part, const Eigen::Vector3d& whole) {
    return part.z() <= kMostLarger * whole.z() + slack_m &&
           part.head<2>().norm() <= kMostLarger * whole.head<2>().norm() + slack_m;
  };
  return fits(a, b) || fits(b, a);
}

std::vector<SurfacePoint> some_colors(const MapSide& map, const Thing& thing) {
  const std::size_t count = std::min(thing.points.size(), kColorSamples);
  std::vector<SurfacePoint> colors;
  colors.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    colors.push_back(map.colors()[thing.points[i * thing.points.size() / count]]);
  }
  return colors;
}

/// Whether most of the smaller one's colours are on the other one, too.
bool may_be_of_colors(const MapSide& map, const Thing& thing, const MapSide& other_map,
                      const Thing& other) {
  if (thing.points.size() > other.points.size()) {
    return may_be_of_colors(other_map, other, map, thing);
  }
  const auto colors = some_colors(map, thing);
  const auto others = some_colors(other_map, other);
  const auto num_alike = std::ranges::count_if(colors, [&](const SurfacePoint& color) {
    return std::ranges::any_of(
        others, [&](const SurfacePoint& there) { return are_alike_in_color(color, there); });
  });
  return static_cast<double>(num_alike) >= kLeastAlikeColors * static_cast<double>(colors.size());
}

/// One thing of each map, and how they would be one.
class Motions {
 public:
  Motions(const ChangedSide& before, const ChangedSide& after, const Eigen::Vector3d& up,
          const MapErrors& errors)
      : before_(before),
        after_(after),
        up_(up),
        errors_(errors),
        gone_(before, up),
        come_(after, up) {
    for (std::size_t g = 0; g < gone_.size(); ++g) {
      now_.push_back(what_is_there(gone_.points(g), after.map, up));
    }
    for (std::size_t c = 0; c < come_.size(); ++c) {
      then_.push_back(what_is_there(come_.points(c), before.map, up));
    }
    by_gone_.resize(num_tries());
    by_come_.resize(num_tries());
    // A scene is for one thread.
    oneapi::tbb::parallel_invoke([this] { recognize_gone(); }, [this] { recognize_come(); });
  }

  /// Pairs of things, and each thing with what is at its place in the other map.
  [[nodiscard]] std::size_t num_tries() const {
    return gone_.size() * come_.size() + gone_.size() + come_.size();
  }

  /// The best motion; nothing: it is none.
  [[nodiscard]] std::optional<MovedThing> best(std::size_t attempt) const {
    const Pair pair = pair_of(attempt);
    if (!is_worth_it(pair)) return std::nullopt;
    std::vector<Pose> motions = {Pose::Identity()};
    if (by_gone_[attempt]) motions.push_back(*by_gone_[attempt]);
    if (by_come_[attempt]) motions.push_back(by_come_[attempt]->inverse(Eigen::Isometry));
    return best_of(before(pair), after(pair), motions);
  }

 private:
  /// Numbers of things; without one it is what is at the place of the other.
  struct Pair {
    std::optional<std::size_t> gone;
    std::optional<std::size_t> come;
  };

  [[nodiscard]] Pair pair_of(std::size_t attempt) const {
    const std::size_t num_pairs = gone_.size() * come_.size();
    if (attempt < num_pairs) {
      return {.gone = attempt / come_.size(), .come = attempt % come_.size()};
    }
    const std::size_t single = attempt - num_pairs;
    if (single < gone_.size()) return {.gone = single, .come = {}};
    return {.gone = {}, .come = single - gone_.size()};
  }
  [[nodiscard]] const Thing& before(const Pair& pair) const {
    return pair.gone ? gone_.thing(*pair.gone) : then_[*pair.come];
  }
  [[nodiscard]] const Thing& after(const Pair& pair) const {
    return pair.come ? come_.thing(*pair.come) : now_[*pair.gone];
  }

  /// Things that may be one, or one that was turned or pushed aside a little.
  [[nodiscard]] bool is_worth_it(const Pair& pair) const {
    if (!pair.gone || !pair.come)
      return !before(pair).points.empty() && !after(pair).points.empty();
    const double slack_m = kSlack_vox * before_.map.voxel_m();
    return may_be_of_size(gone_.size_m(*pair.gone), come_.size_m(*pair.come), slack_m) &&
           may_be_of_colors(before_.map, before(pair), after_.map, after(pair));
  }

  void recognize_gone() {
    const std::unique_ptr<const Scene> scene = after_.map.scene();
    for (std::size_t attempt = 0; attempt < num_tries(); ++attempt) {
      const Pair pair = pair_of(attempt);
      if (!pair.gone || !is_worth_it(pair)) continue;
      by_gone_[attempt] =
          gone_.motion_to(*pair.gone, after_.map.points_at(after(pair).points), *scene);
    }
  }

  void recognize_come() {
    const std::unique_ptr<const Scene> scene = before_.map.scene();
    for (std::size_t attempt = 0; attempt < num_tries(); ++attempt) {
      const Pair pair = pair_of(attempt);
      if (!pair.come || !is_worth_it(pair)) continue;
      by_come_[attempt] =
          come_.motion_to(*pair.come, before_.map.points_at(before(pair).points), *scene);
    }
  }

  [[nodiscard]] std::optional<MovedThing> best_of(const Thing& before, const Thing& after,
                                                  const std::vector<Pose>& motions) const {
    std::optional<MovedThing> best;
    for (const Pose& X : motions) {
      MovedThing moved{.before = before, .after = after, .X_after_before = X};
      refine(moved, kReach_vox);
      leave_what_stays(moved);
      if (!may_be(moved)) continue;
      complete(moved);
      assess(moved);
      if (moved.score < kLeastScore || (best && moved.points <= best->points)) continue;
      best = std::move(moved);
    }
    return best;
  }

  void refine(MovedThing& moved, double reach_vox) const {
    moved.X_after_before = refined_motion(
        before_.map.points_at(moved.before.points), after_.map.points_at(moved.after.points),
        moved.X_after_before, up_, before_.map.voxel_m(), reach_vox * before_.map.voxel_m());
  }

  void leave_what_stays(MovedThing& moved) const {
    const std::size_t count = moved.before.points.size() + moved.after.points.size();
    const Pose& X = moved.X_after_before;
    drop_what_stays(moved.before, before_.map, X, after_.map);
    drop_what_stays(moved.after, after_.map, X.inverse(Eigen::Isometry), before_.map);
    const bool is_less = moved.before.points.size() + moved.after.points.size() < count;
    if (is_less) refine(moved, kReach_vox);
  }

  /// Whether what is to be seen of the smaller one mostly agrees: the other may have more.
  [[nodiscard]] bool may_be(const MovedThing& moved) const {
    const Pose& X = moved.X_after_before;
    const Evidence evidence =
        moved.before.points.size() <= moved.after.points.size()
            ? evidence_of(before_.map, moved.before.points, X, after_.map)
            : evidence_of(after_.map, moved.after.points, X.inverse(Eigen::Isometry), before_.map);
    return evidence.agreement() >= kLeastBegin;
  }

  void complete(MovedThing& moved) const {
    for (int round = 0; round < kRounds; ++round) {
      const Pose& X = moved.X_after_before;
      const Pose X_back = X.inverse(Eigen::Isometry);
      const std::vector<CloudPoint> all = whole_surface(moved, before_.map, after_.map);
      const bool has_more_before =
          add_what_follows(moved.before, before_.map, X, after_.map, transformed(X_back, all), up_);
      const bool has_more_after =
          add_what_follows(moved.after, after_.map, X_back, before_.map, all, up_);
      if (!has_more_before && !has_more_after) return;
      refine(moved, kReach_vox / 2.0);
    }
  }

  void assess(MovedThing& moved) const {
    const Pose& X = moved.X_after_before;
    const Evidence now =
        evidence_of(before_.map, moved.before.points, X, after_.map, moved.after.points);
    const Evidence then = evidence_of(after_.map, moved.after.points, X.inverse(Eigen::Isometry),
                                      before_.map, moved.before.points);
    const Evidence stays =
        evidence_of(before_.map, moved.before.points, Pose::Identity(), after_.map);
    const Evidence stayed =
        evidence_of(after_.map, moved.after.points, Pose::Identity(), before_.map);
    const double agreement = std::min(now.agreement(), then.agreement());
    const double gain = now.agreement() + then.agreement() - stays.agreement() - stayed.agreement();
    const double least_points = kLeastPoints * std::pow(0.01 / before_.map.voxel_m(), 2);
    const bool is_seen = std::max(now.found, then.found) >= kLeastFound &&
                         std::min(now.found, then.found) >= kLeastFoundOfBoth &&
                         static_cast<double>(std::min(moved.before.points.size(),
                                                      moved.after.points.size())) >= least_points;
    const bool is_elsewhere =
        shift_m(moved) > errors_.distance_m && gain >= 2.0 * kBetterThanBefore;
    moved.score = is_seen && is_elsewhere ? agreement : 0.0;
    moved.points = now.found * static_cast<double>(moved.before.points.size()) +
                   then.found * static_cast<double>(moved.after.points.size());
  }

  /// Of the point that moves farthest.
  [[nodiscard]] double shift_m(const MovedThing& moved) const {
    double most_m = 0.0;
    for (const std::size_t i : moved.before.points) {
      const Eigen::Vector3d p = position_of(before_.map.points()[i]).cast<double>();
      most_m = std::max(most_m, (moved.X_after_before * p - p).norm());
    }
    return most_m;
  }

  ChangedSide before_;
  ChangedSide after_;
  Eigen::Vector3d up_;
  MapErrors errors_;
  Candidates gone_;
  Candidates come_;
  std::vector<Thing> now_;   // what is at the place of each that is gone
  std::vector<Thing> then_;  // what was at the place of each that has come
  // Of each attempt, by the recogniser: of the thing that is gone, into the map after, and of the
  // one that has come, into the map before.
  std::vector<std::optional<Pose>> by_gone_;
  std::vector<std::optional<Pose>> by_come_;
};

bool share_much(const Thing& a, const Thing& b) {
  std::vector<std::size_t> common;
  std::ranges::set_intersection(a.points, b.points, std::back_inserter(common));
  const std::size_t smaller = std::min(a.points.size(), b.points.size());
  return static_cast<double>(common.size()) > kMostShared * static_cast<double>(smaller);
}

/// Whether a good part of the thing is a small part of something that has changed as a whole.
bool is_torn_off(const Thing& thing, std::span<const ChangeGroup> groups) {
  return std::ranges::any_of(groups, [&](const ChangeGroup& group) {
    if (!group.is_thing) return false;
    std::vector<std::size_t> common;
    std::ranges::set_intersection(thing.points, group.points, std::back_inserter(common));
    const auto count = static_cast<double>(common.size());
    return count > kMostShared * static_cast<double>(thing.points.size()) &&
           count < kLeastOfWhole * static_cast<double>(group.points.size());
  });
}

}  // namespace

std::vector<CloudPoint> whole_surface(const MovedThing& moved, const MapSide& before,
                                      const MapSide& after) {
  std::vector<CloudPoint> all = after.points_at(moved.after.points);
  const auto more = transformed(moved.X_after_before, before.points_at(moved.before.points));
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::vector<MovedThing> find_moved(const ChangedSide& before, const ChangedSide& after,
                                   const Eigen::Vector3d& up, const MapErrors& errors) {
  const Motions motions(before, after, up, errors);
  std::vector<std::optional<MovedThing>> tries(motions.num_tries());
  oneapi::tbb::parallel_for(std::size_t{0}, tries.size(),
                            [&](std::size_t i) { tries[i] = motions.best(i); });
  std::vector<MovedThing> found;
  for (auto& moved : tries) {
    if (moved) found.push_back(std::move(*moved));
  }
  // A part of a thing moves as it does, and a part of it may be like a part of another.
  std::ranges::stable_sort(found, std::ranges::greater{}, &MovedThing::points);
  std::vector<MovedThing> chosen;
  for (MovedThing& moved : found) {
    const bool is_taken = std::ranges::any_of(chosen, [&](const MovedThing& other) {
      return share_much(other.before, moved.before) || share_much(other.after, moved.after);
    });
    const bool is_part =
        is_torn_off(moved.before, before.groups) || is_torn_off(moved.after, after.groups);
    if (!is_taken && !is_part) chosen.push_back(std::move(moved));
  }
  return chosen;
}

}  // namespace kintsugi::segmenter
