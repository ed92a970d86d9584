#include "segmenter/evaluation/objects/object_scores.hpp"

#include <algorithm>

namespace kintsugi::segmenter {
namespace {

std::optional<double> share(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

bool is_in(const SizeClass& size, std::int64_t points) {
  return points >= size.min_points && points < size.end_points;
}

}  // namespace

std::optional<double> Tally::recall() const { return share(num_found, num_true); }

std::optional<double> Tally::precision() const { return share(num_right, num_told); }

Tally tally(const ObjectScores& scores, const SizeClass& size, const std::string& kind) {
  Tally tally;
  for (const TrueOutcome& object : scores.truth) {
    if (!is_in(size, object.points) || (!kind.empty() && object.kind != kind)) continue;
    ++tally.num_true;
    if (object.is_found) ++tally.num_found;
  }
  for (const ClaimOutcome& claim : scores.claims) {
    const auto object = std::ranges::find(scores.truth, claim.key, &TrueOutcome::key);
    const bool has_object = claim.is_right && object != scores.truth.end();
    if (!is_in(size, has_object ? object->points : claim.points)) continue;
    if (!kind.empty() && (has_object ? object->kind : claim.kind) != kind) continue;
    ++tally.num_told;
    if (claim.is_right) ++tally.num_right;
  }
  return tally;
}

}  // namespace kintsugi::segmenter
