#include "mapper/core/slices/patch_maker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace kintsugi::mapper {
namespace {

constexpr double kLeastMotion_vox = 0.1;  // a smaller one is no error

// How often, and at how many of them, patches are looked at again where several robots have
// surface: some 0.4 ms each, for patches of 784 points among 4,000.
constexpr std::int64_t kCommonPeriod_us = 1'000'000;
constexpr std::size_t kCommonPatches = 300;

/// Patches are segmented together up to the last one of a batch.
std::vector<CloudSlice> as_batch(std::vector<CloudSlice> slices) {
  if (!slices.empty()) slices.back().ends_batch = true;
  return slices;
}

// Of points: about a tenth of a second of the stream, so that the first patches of many are
// segmented while the others are still on their way.
constexpr std::size_t kBatch = 30'000;

/// As many batches, each of a later time: by that a patch which comes late is known.
/// @return the time of the last one, microseconds
std::int64_t divide_into_batches(std::vector<CloudSlice>& slices, std::int64_t utime) {
  std::size_t num_points = 0;
  for (CloudSlice& slice : slices) {
    if (num_points >= kBatch) {
      ++utime;
      num_points = 0;
    }
    slice.utime = utime;
    num_points += slice.points_W.size();
    slice.ends_batch = num_points >= kBatch || &slice == &slices.back();
  }
  return utime;
}

/// The largest distance that a corner of a box moves, metres.
double motion_m(const Eigen::AlignedBox3d& box_P, const Pose& X_WP_before, const Pose& X_WP_after) {
  double largest_m = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p_P = box_P.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    largest_m = std::max(largest_m, (X_WP_after * p_P - X_WP_before * p_P).norm());
  }
  return largest_m;
}

/// Of no points, the origin: also a patch that has none lies somewhere.
Eigen::AlignedBox3d box_of(const std::vector<CloudPoint>& points) {
  if (points.empty()) return Eigen::AlignedBox3d(Eigen::Vector3d(0.0, 0.0, 0.0));
  Eigen::AlignedBox3d box;
  for (const CloudPoint& p : points) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return box;
}

}  // namespace

std::vector<PatchRun> PatchMaker::keep(const ExtractedSurface& left, const SeenAt& seen_at) {
  for (const auto& [tile, points_W] : by_tile(left)) {
    std::vector<CloudPoint>& left_W = patch_at(tile, seen_at).left_W;
    left_W.insert(left_W.end(), points_W.begin(), points_W.end());
  }
  std::vector<PatchRun> runs;
  runs.reserve(left.blocks.size());
  for (const ExtractedSurface::Block& block : left.blocks) {
    runs.push_back({block.num_points, patch_at(grid_.tile_of(block.coord), seen_at).number});
  }
  return runs;
}

std::vector<PatchRun> PatchMaker::patches_of(const MeshPiece& piece, double resolution_m) {
  std::vector<PatchRun> runs;
  const double block_m = kBlockSide * resolution_m;
  for (const MeshPiece::Vertex& vertex : piece.vertices) {
    const auto block = [&](float p) { return static_cast<int>(std::floor(p / block_m)); };
    const auto found = newest_.find(
        grid_.tile_of(make_block_coord(block(vertex.x), block(vertex.y), block(vertex.z))));
    const int patch = found == newest_.end() ? kNoPatch : found->second;
    if (runs.empty() || runs.back().patch != patch) {
      runs.push_back({0, patch});
      const auto place = places_.find(patch);
      if (place != places_.end()) place->second.has_vertices = true;
    }
    ++runs.back().num_points;
  }
  return runs;
}

/// The patch of a tile that may be sent again; a new one where there is none.
PatchMaker::Patch& PatchMaker::patch_at(const TileCoord& tile, const SeenAt& seen_at) {
  Patch& patch = patches_[tile];
  if (patch.number != kNoPatch) return patch;
  patch.number = next_number_++;
  places_[patch.number] = {.tile = tile,
                           .keyframe = seen_at.keyframe,
                           .X_WP = seen_at.place.X_WU,
                           .part = seen_at.place.part};
  newest_[tile] = patch.number;
  return patch;
}

std::vector<CloudSlice> PatchMaker::reopen(std::span<const TileVisit> visits,
                                           const CloudSlice& header, const SeenAt& seen_at) {
  std::vector<CloudSlice> ended;
  for (const TileVisit& visit : visits) {
    Patch& patch = patch_at(visit.tile, seen_at);
    if (visit.number != TileVisit::kOpen) {
      Place& place = places_.at(patch.number);
      place.in_volume = false;
      if (place.id != kNoId) ended.push_back(revision_of(place, {}, header));
      end(patch.number);
      const auto closed = closed_.extract(visit);
      if (closed.empty()) {  // forgotten: it begins anew
        patch = Patch();
        patch_at(visit.tile, seen_at);
        continue;
      }
      patch.number = closed.mapped();
    }
    go_on(patch, visit);
  }
  return as_batch(std::move(ended));
}

/// Under another number, as points that were given with the one before count no more.
void PatchMaker::go_on(Patch& patch, const TileVisit& visit) {
  auto place = places_.extract(patch.number);
  patch.number = next_number_++;
  place.key() = patch.number;
  if (place.mapped().id != kNoId) number_of_id_[place.mapped().id] = patch.number;
  places_.insert(std::move(place));
  patch.left_W.clear();
  newest_[visit.tile] = patch.number;
}

void PatchMaker::end(int number) {
  const auto place = places_.find(number);
  number_of_id_.erase(place->second.id);
  places_.erase(place);
}

void PatchMaker::give_id(int number) {
  number_of_id_[next_id_] = number;
  places_.at(number).id = next_id_++;
}

CommonSurface::Name PatchMaker::name_of(const Place& place) {
  return {place.guest ? place.guest->session : CommonSurface::kOwnSession, place.id};
}

/// The next revision: these points, but for those that others have better.
CloudSlice PatchMaker::revision_of(Place& place, std::vector<CloudPoint> points_P,
                                   const CloudSlice& header) {
  if (common_) {
    common_->set(name_of(place), std::move(points_P), place.X_WP);
    points_P = common_->take(name_of(place));
  }
  return slice_of(place, std::move(points_P), header);
}

CloudSlice PatchMaker::slice_of(Place& place, std::vector<CloudPoint> points_P,
                                const CloudSlice& header) {
  CloudSlice slice = header;
  slice.kind = SliceKind::kPatch;
  slice.id = place.id;
  slice.X_WP = place.X_WP;
  slice.part = place.part;
  slice.keyframe = place.guest ? kNotOfCamera : place.keyframe;
  slice.correction = correction_;
  slice.in_volume = place.in_volume;
  slice.revision = ++place.revision;
  slice.points_W = std::move(points_P);
  revision_sum_ += slice.revision > 0 ? 1 : 0;
  return slice;
}

std::optional<PatchPlace> PatchMaker::place_of(int patch) const {
  const auto place = places_.find(patch);
  if (place == places_.end()) return std::nullopt;
  return PatchPlace{
      .X_WP = place->second.X_WP, .correction = correction_, .part = place->second.part};
}

std::vector<CloudSlice> PatchMaker::make(const PatchBatch& batch, const ExtractedSurface& in_volume,
                                         const CloudSlice& header) {
  std::vector<CloudSlice> slices = revisions_of(batch, in_volume, header);
  std::ranges::move(revisions_of(changed_by_others(header.utime), header),
                    std::back_inserter(slices));
  return as_batch(std::move(slices));
}

std::vector<CloudSlice> PatchMaker::revisions_of(const PatchBatch& batch,
                                                 const ExtractedSurface& in_volume,
                                                 const CloudSlice& header) {
  auto present_W = by_tile(in_volume);
  std::vector<CloudSlice> slices;
  for (const PatchBatch::Patch& due : batch.patches) {
    Patch& patch = patch_at(due.tile, {due.keyframe, due.place});
    Place& place = places_.at(patch.number);
    place.keyframe = due.keyframe;
    std::vector<CloudPoint> points_W = due.in_volume ? patch.left_W : std::move(patch.left_W);
    if (due.in_volume) {
      const auto& more_W = present_W[due.tile];
      points_W.insert(points_W.end(), more_W.begin(), more_W.end());
    }
    if (place.id != kNoId || !points_W.empty()) {
      if (place.id == kNoId) give_id(patch.number);
      place.X_WP = due.place.X_WU;
      place.part = due.place.part;
      place.in_volume = due.in_volume;
      slices.push_back(revision_of(place, std::move(points_W), header));
    }
    if (!due.in_volume) close(due.tile);
  }
  return slices;
}

std::vector<CommonSurface::Rest> PatchMaker::changed_by_others(std::int64_t utime) {
  if (!common_ || utime < common_due_utime_) return {};
  common_due_utime_ = utime + kCommonPeriod_us;
  return common_->take_changed(kCommonPatches);
}

std::vector<CloudSlice> PatchMaker::revisions_of(std::vector<CommonSurface::Rest> patches,
                                                 const CloudSlice& header) {
  std::vector<CloudSlice> slices;
  slices.reserve(patches.size());
  for (auto& [name, points_P] : patches) {
    Place& place = places_.at(number_of_id_.at(name.id));
    slices.push_back(slice_of(place, std::move(points_P), header));
  }
  return slices;
}

/// A patch is forgotten if nothing of it was given: most places that the camera sees only once, and
/// from afar, never have a point.
void PatchMaker::close(const TileCoord& tile) {
  const Patch patch = std::move(patches_.extract(tile).mapped());
  const int visit = num_closed_[tile]++;
  const Place& place = places_.at(patch.number);
  if (place.id != kNoId || place.has_vertices) {
    closed_[{tile, visit}] = patch.number;
  } else {
    places_.erase(patch.number);
  }
}

std::vector<CloudSlice> PatchMaker::take_in(std::vector<GuestPatch> patches,
                                            const CloudSlice& header) {
  std::vector<CloudSlice> slices;
  slices.reserve(patches.size());
  for (GuestPatch& taken : patches) {
    const auto [number, is_new] = of_guests_.try_emplace(taken.name, next_number_);
    Place& place = places_[number->second];
    if (is_new) give_id(next_number_++);
    place.guest = {
        .session = taken.name.session, .X_UP = taken.X_UP, .box_P = box_of(taken.points_P)};
    place.in_volume = taken.in_volume;
    place.keyframe = taken.at.keyframe;
    place.X_WP = pose_of(place, taken.at.place.X_WU);
    place.part = taken.at.place.part;
    slices.push_back(revision_of(place, std::move(taken.points_P), header));
  }
  return as_batch(std::move(slices));
}

/// X_WP, if the keyframe with which the patch moves is moved like this.
PatchPose PatchMaker::pose_of(const Place& place, const Pose& X_WU) {
  return place.guest ? Pose(X_WU * place.guest->X_UP) : X_WU;
}

Eigen::AlignedBox3d PatchMaker::box_P(const Place& place, double resolution_m) const {
  if (place.guest) return place.guest->box_P;
  const double side_m = grid_.side_blocks() * kBlockSide * resolution_m;
  const Eigen::Vector3d low(place.tile.x, place.tile.y, place.tile.z);
  return {side_m * low, side_m * (low + Eigen::Vector3d::Ones())};
}

std::vector<CloudSlice> PatchMaker::correct(const MapDeformation& deformation,
                                            const CloudSlice& header, const Pose& X_WU_now) {
  correction_ = deformation.number();
  std::map<int, std::vector<PatchMotion>> motions;  // by part
  for (auto& [number, place] : places_) {
    const auto [X_WU, part] = deformation.place(place.keyframe);
    const PatchPose X_WP = pose_of(place, X_WU);
    if (place.X_WP == X_WP) continue;
    const double moved_m =
        motion_m(box_P(place, header.resolution_m), place.X_WP.pose(), X_WP.pose());
    if (moved_m <= kLeastMotion_vox * header.resolution_m) continue;
    place.X_WP = X_WP;
    place.part = part;
    if (place.id == kNoId) continue;  // it was never sent
    motions[part].push_back({place.id, X_WP});
    if (common_) common_->move(name_of(place), X_WP);
  }
  std::vector<CloudSlice> slices;
  for (auto& [part, of_part] : motions) {
    CloudSlice& slice = slices.emplace_back(header);
    slice.kind = SliceKind::kCorrection;
    slice.ends_batch = true;
    slice.correction = correction_;
    slice.part = part;
    slice.X_WP = X_WU_now;
    slice.id = next_id_++;
    slice.motions = std::move(of_part);
    std::ranges::sort(slice.motions, {}, &PatchMotion::id);
    for (const MapDeformation::PartLoop& loop : deformation.loops()) {
      if (loop.part == part) slice.loops.push_back(loop.link);
    }
  }
  return slices;
}

std::vector<CloudSlice> PatchMaker::finish(const CloudSlice& header) {
  PatchBatch everything;
  for (const auto& [tile, patch] : patches_) {
    const Place& place = places_.at(patch.number);
    everything.patches.push_back({tile, false, place.keyframe, {place.X_WP.pose(), place.part}});
  }
  std::vector<CloudSlice> slices = revisions_of(everything, {}, header);
  if (common_) {
    std::ranges::move(revisions_of(common_->take_all_changed(), header),
                      std::back_inserter(slices));
  }
  const std::int64_t end_utime = divide_into_batches(slices, header.utime);
  CloudSlice& last = slices.emplace_back(header);
  last.utime = end_utime;
  last.kind = SliceKind::kFinal;
  last.id = next_id_;
  last.revision_sum = revision_sum_;
  return slices;
}

std::map<TileCoord, std::vector<CloudPoint>> PatchMaker::by_tile(
    const ExtractedSurface& surface) const {
  std::map<TileCoord, std::vector<CloudPoint>> tiles;
  const std::span points_W(surface.points_W);
  for (const ExtractedSurface::Block& block : surface.blocks) {
    std::vector<CloudPoint>& to = tiles[grid_.tile_of(block.coord)];
    const auto from = points_W.subspan(block.first_point, block.num_points);
    to.insert(to.end(), from.begin(), from.end());
  }
  return tiles;
}

}  // namespace kintsugi::mapper
