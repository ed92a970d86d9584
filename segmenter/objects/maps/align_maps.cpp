#include "segmenter/objects/maps/align_maps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/objects/maps/map_agreement.hpp"
#include "segmenter/objects/maps/map_search.hpp"
#include "segmenter/objects/maps/refine_alignment.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kMostHypotheses = 12;
// A tenth of a room's surface may have come or gone without doubt about the place; of maps of
// different rooms that share a floor and a wall, a third and more is contradicted.
constexpr double kLeastAgreement = 0.8;
// Of the smaller map. Less than that, floor and one wall alone, any two rooms have in common.
constexpr double kLeastOverlap = 0.4;
// Without views nothing contradicts, and shape alone must.
constexpr double kLeastOverlapUnseen = 0.6;
// A second place that fits so nearly as well could be the right one.
constexpr double kAmbiguous = 0.85;
constexpr double kSameSession = 0.6;  // score from which no other place is looked for
// Two refined places that are the same one: a map's error, generously.
constexpr double kSamePlace_m = 0.2;
constexpr double kSamePlace_rad = 5.0 * std::numbers::pi / 180.0;
constexpr double kSearchReach_m = 0.3;  // of the refinement: the error of the search
constexpr double kRoughReach_m = 0.08;
constexpr double kFinalReach_m = 0.04;
// To tell which hypotheses are one place; a pose has six unknowns.
constexpr std::size_t kRoughSamples = 2'000;
constexpr std::size_t kFineSamples = 6'000;

struct Candidate {
  RefinedAlignment refined;
  MapAgreement agreement;
};

Eigen::Vector3d up_of(const ObservedMap& map) {
  UpDirection up;
  up.add(map.points_W);
  return up.up_W();
}

bool is_same_place(const Pose& a, const Pose& b, const Eigen::Vector3d& center_B) {
  const Pose between = a.inverse(Eigen::Isometry) * b;
  return (a * center_B - b * center_B).norm() < kSamePlace_m &&
         Eigen::AngleAxisd(between.linear()).angle() < kSamePlace_rad;
}

/// Every n-th of the samples.
std::vector<CloudPoint> some_of(const std::vector<CloudPoint>& samples, std::size_t number) {
  const std::size_t step = std::max<std::size_t>(1, samples.size() / number);
  std::vector<CloudPoint> some;
  some.reserve(samples.size() / step + 1);
  for (std::size_t i = 0; i < samples.size(); i += step) some.push_back(samples[i]);
  return some;
}

std::optional<Candidate> candidate_at(const ComparedMap& before, const ComparedMap& after,
                                      const Pose& X_AB_rough) {
  const auto refined = refine_alignment(after.surface, some_of(before.samples, kFineSamples),
                                        X_AB_rough, kRoughReach_m, kFinalReach_m);
  if (!refined) return std::nullopt;
  Candidate candidate{*refined, compare(before, after, refined->X_AB)};
  spdlog::debug("a place: overlap {:.2f}, agreement {:.2f}, colour {:.2f}, score {:.2f}",
                candidate.agreement.overlap(), candidate.agreement.agreement(),
                candidate.agreement.color, candidate.agreement.score());
  return candidate;
}

double least_overlap(const ComparedMap& before, const ComparedMap& after) {
  return before.space.empty() || after.space.empty() ? kLeastOverlapUnseen : kLeastOverlap;
}

/// Why a place is not accepted; empty: it is.
std::string refusal_of(const Candidate& candidate, double least) {
  const MapAgreement& agreement = candidate.agreement;
  if (agreement.overlap() < least) {
    return fmt::format(
        "at the best place only {:.0f} % of the smaller map is in the other one, "
        "expected {:.0f} % or more",
        100.0 * agreement.overlap(), 100.0 * least);
  }
  if (agreement.agreement() < kLeastAgreement) {
    return fmt::format(
        "at the best place only {:.0f} % of the surface that the other map's camera "
        "could see was there, expected {:.0f} % or more",
        100.0 * agreement.agreement(), 100.0 * kLeastAgreement);
  }
  return "";
}

AlignmentResult accepted(const Candidate& candidate) {
  const RefinedAlignment& refined = candidate.refined;
  return {MapAlignment{.X_AB = refined.X_AB,
                       .rms_m = refined.rms_m,
                       .sigma_m = refined.sigma_m,
                       .sigma_rad = refined.sigma_rad,
                       .overlap = candidate.agreement.overlap(),
                       .agreement = candidate.agreement.agreement()},
          ""};
}

AlignmentResult refused(const std::string& why) {
  return {std::nullopt, "the maps do not fit: " + why};
}

/// The distinct places to which hypotheses lead.
std::vector<Pose> rough_places(const std::vector<MapHypothesis>& hypotheses, const ComparedMap& B,
                               const ComparedMap& A, const Eigen::Vector3d& center_B) {
  const std::vector<CloudPoint> samples_B = some_of(B.samples, kRoughSamples);
  std::vector<Pose> places;
  for (const MapHypothesis& hypothesis : hypotheses) {
    const auto rough =
        refine_alignment(A.surface, samples_B, hypothesis.X_AB, kSearchReach_m, kRoughReach_m);
    if (!rough) continue;
    const bool is_known = std::ranges::any_of(
        places, [&](const Pose& other) { return is_same_place(other, rough->X_AB, center_B); });
    if (!is_known) places.push_back(rough->X_AB);
  }
  return places;
}

std::vector<Candidate> candidates_at(const std::vector<Pose>& places, const ComparedMap& B,
                                     const ComparedMap& A, const Eigen::Vector3d& center_B) {
  std::vector<Candidate> candidates;
  for (const Pose& place : places) {
    auto candidate = candidate_at(B, A, place);
    if (!candidate) continue;
    const bool is_known = std::ranges::any_of(candidates, [&](const Candidate& other) {
      return is_same_place(other.refined.X_AB, candidate->refined.X_AB, center_B);
    });
    if (!is_known) candidates.push_back(*std::move(candidate));
  }
  std::ranges::stable_sort(candidates, std::ranges::greater{},
                           [](const Candidate& c) { return c.agreement.score(); });
  return candidates;
}

Eigen::Vector3d center_of(const std::vector<CloudPoint>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& sample : samples) sum += Eigen::Vector3d(sample.x, sample.y, sample.z);
  return sum / static_cast<double>(samples.size());
}

}  // namespace

AlignmentResult align_maps(const ObservedMap& before, const ObservedMap& after) {
  const ComparedMap B(before);
  const ComparedMap A(after);
  if (B.samples.empty() || A.samples.empty()) return refused("one of them has no surface");
  const double least = least_overlap(B, A);
  // Maps of one session, or of sessions that began at the same place.
  const Eigen::Vector3d center_B = center_of(B.samples);
  const std::vector<Candidate> here =
      candidates_at(rough_places({MapHypothesis{}}, B, A, center_B), B, A, center_B);
  if (!here.empty() && here[0].agreement.score() >= kSameSession &&
      refusal_of(here[0], least).empty()) {
    return accepted(here[0]);
  }
  const std::vector<MapHypothesis> hypotheses =
      search_map(A.samples, up_of(after), B.samples, up_of(before), kMostHypotheses);
  const std::vector<Candidate> candidates =
      candidates_at(rough_places(hypotheses, B, A, center_B), B, A, center_B);
  if (candidates.empty()) return refused("no place was found where their surfaces meet");
  const Candidate& best = candidates.front();
  if (const std::string why = refusal_of(best, least); !why.empty()) return refused(why);
  if (candidates.size() > 1) {
    const double share = candidates[1].agreement.score() / best.agreement.score();
    if (share > kAmbiguous && refusal_of(candidates[1], least).empty()) {
      const double apart_m =
          (best.refined.X_AB * center_B - candidates[1].refined.X_AB * center_B).norm();
      return refused(
          fmt::format("there are two places that fit nearly alike ({:.0f} %), {:.1f} m "
                      "apart",
                      100.0 * share, apart_m));
    }
  }
  return accepted(best);
}

}  // namespace kintsugi::segmenter
