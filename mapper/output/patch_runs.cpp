#include "mapper/output/patch_runs.hpp"

#include <algorithm>

namespace kintsugi::mapper {

void PatchRuns::append(std::size_t num_points, const std::vector<PatchRun>& runs) {
  const auto add = [&](const PatchRun& run) {
    const std::int64_t begin = runs_.empty() ? 0 : runs_.back().end;
    const bool goes_on =
        !runs_.empty() && runs_.back().patch == run.patch && runs_.back().part == run.part;
    if (!goes_on) runs_.push_back({.end = begin, .patch = run.patch, .part = run.part});
    runs_.back().end += static_cast<std::int64_t>(run.num_points);
  };
  if (runs.empty()) add({.num_points = num_points});
  for (const PatchRun& run : runs) add(run);
}

void PatchRuns::place(const PlaceOfPatch& place_of) {
  for (Run& run : runs_) {
    const bool was_moved = place_of && run.patch != kNoPatch;
    run.place =
        was_moved ? place_of(run.patch) : PatchPlace{.X_WP = {}, .correction = 0, .part = run.part};
  }
}

std::set<int> PatchRuns::parts() const {
  std::set<int> parts;
  for (const Run& run : runs_) {
    if (run.place) parts.insert(run.place->part);
  }
  return parts;
}

void PatchRuns::select(int part) {
  std::int64_t begin = 0;
  std::int64_t num_dropped = 0;
  for (Run& run : runs_) {
    run.is_kept = run.place && run.place->part == part;
    run.num_dropped = num_dropped;
    if (!run.is_kept) num_dropped += run.end - begin;
    begin = run.end;
  }
}

std::optional<CloudPoint> PatchRuns::moved(std::int64_t number, const CloudPoint& point) const {
  const Run& run = run_of(number);
  if (!run.is_kept) return std::nullopt;
  return kintsugi::moved({&point, 1}, run.place->X_WP).front();
}

std::optional<std::int64_t> PatchRuns::number_of_kept(std::int64_t number) const {
  const Run& run = run_of(number);
  return run.is_kept ? std::optional(number - run.num_dropped) : std::nullopt;
}

const PatchRuns::Run& PatchRuns::run_of(std::int64_t number) const {
  return *std::ranges::upper_bound(runs_, number, {}, &Run::end);
}

}  // namespace kintsugi::mapper
