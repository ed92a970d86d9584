#include "segmenter/views/view_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "segmenter/views/packed_depth.hpp"

namespace kintsugi::segmenter {
namespace {

/// Where a view has no depth at all; only how often it is kept depends on it.
constexpr double kUnknownScene_m = 1.0;

/// The median of what was measured.
double scene_depth_m(std::span<const std::uint16_t> depth_mm) {
  std::vector<std::uint16_t> measured;
  measured.reserve(depth_mm.size());
  std::ranges::copy_if(depth_mm, std::back_inserter(measured), [](auto mm) { return mm > 0; });
  if (measured.empty()) return kUnknownScene_m;
  const auto middle = measured.begin() + std::ssize(measured) / 2;
  std::ranges::nth_element(measured, middle);
  return 1e-3 * *middle;
}

/// Of the image that has every step-th pixel; its pixel centres are integers, too.
Intrinsics small_intrinsics(const CameraView& view) {
  const double step = view.depth_step;
  const int first_px = view.depth_step / 2;  // in integers, as CameraView tells
  Intrinsics small;
  small.fx = view.intrinsics.fx / step;
  small.fy = view.intrinsics.fy / step;
  small.cx = (view.intrinsics.cx - first_px) / step;
  small.cy = (view.intrinsics.cy - first_px) / step;
  small.width = view.depth_width();
  small.height = view.depth_height();
  return small;
}

double seconds_between(const KeptView& a, const KeptView& b) {
  return 1e-6 * static_cast<double>(b.utime - a.utime);
}

}  // namespace

double view_change(const Intrinsics& camera, double scene_m, const Pose& X_WA, const Pose& X_WB) {
  const double half_width = 0.5 * camera.width / camera.fx;
  const Pose X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  const double moved = X_AB.translation().norm() / (2.0 * half_width * scene_m);
  const double turned = Eigen::AngleAxisd(X_AB.linear()).angle() / (2.0 * std::atan(half_width));
  return moved + turned;
}

ViewRecord::ViewRecord(std::int64_t map_session, std::string map_name) {
  set_.map_session = map_session;
  set_.map_name = std::move(map_name);
}

ViewRecord::ViewRecord(ViewSet saved, const SegmentMap& map)
    : set_(std::move(saved)), motions_(map.motions()) {
  if (!set_.views.empty()) last_utime_ = set_.views.back().utime;
  for (const SliceRecord& slice : map.cloud().slices()) {
    headers_[slice.slice_id] = slice.place;
    last_patch_[slice.place.part] = slice.slice_id;
  }
}

void ViewRecord::add(const CameraView& message) {
  if (!is_located(message.state) || message.utime <= last_utime_) return;
  last_utime_ = message.utime;
  KeptView view;
  view.utime = message.utime;
  view.part = message.part;
  view.X_WC = view.X_PC = message.X_WC;
  view.intrinsics = small_intrinsics(message);
  if (view.intrinsics.width <= 0 || view.intrinsics.height <= 0) return;
  if (!is_news(view, scene_depth_m(message.depth_mm))) return;
  view.packed_depth = std::make_shared<const std::vector<std::uint8_t>>(
      pack_depth(message.depth_mm, static_cast<std::size_t>(view.intrinsics.width)));
  set_.views.push_back(std::move(view));
  thin_out();
}

bool ViewRecord::is_news(const KeptView& view, double scene_m) const {
  if (set_.views.empty()) return true;
  const KeptView& last = set_.views.back();
  return last.part != view.part || seconds_between(last, view) >= kRevisit_s ||
         view_change(view.intrinsics, scene_m, last.X_WC, view.X_WC) >= kShare;
}

void ViewRecord::thin_out() {
  if (set_.views.size() <= kMaxViews) return;
  // The first and the last one stay: the next view is compared with that.
  auto least = set_.views.end();
  double least_gap = 0.0;
  for (auto view = set_.views.begin() + 1; view + 1 != set_.views.end(); ++view) {
    const KeptView& before = view[-1];
    const KeptView& after = view[1];
    const double gap = view_change(view->intrinsics, kUnknownScene_m, before.X_WC, after.X_WC) +
                       seconds_between(before, after) / kRevisit_s;
    if (least != set_.views.end() && gap >= least_gap) continue;
    least = view;
    least_gap = gap;
  }
  set_.views.erase(least);
}

void ViewRecord::add(const CloudSlice& slice) {
  for (KeptView& view : set_.views) {
    if (view.patch == KeptView::kNoPatch && view.utime < slice.utime) hang_up(view);
  }
  motions_.learn(slice);
  if (slice.kind == SliceKind::kCorrection || slice.kind == SliceKind::kFinal) return;
  const PatchPlace place = motions_.place_of(slice);
  PatchPlace& known = headers_[slice.id];
  if (place.correction >= known.correction) known = place;
  // Those of another mapper move with its keyframes, wherever this camera is.
  if (slice.keyframe >= 0) last_patch_[slice.part] = slice.id;
}

void ViewRecord::append(const ViewRecord& later) {
  for (const KeptView& view : later.set_.views) {
    if (view.utime <= last_utime_) continue;
    set_.views.push_back(view);
    thin_out();
  }
  last_utime_ = std::max(last_utime_, later.last_utime_);
  for (const auto& [id, place] : later.headers_) {
    PatchPlace& known = headers_[id];
    if (place.correction >= known.correction) known = place;
  }
  for (const auto& [part, id] : later.last_patch_) last_patch_[part] = id;
  for (const auto& [id, place] : later.motions_.places()) motions_.learn(id, place);
}

void ViewRecord::hang_up(KeptView& view) const {
  const auto last = last_patch_.find(view.part);
  if (last == last_patch_.end()) return;
  view.patch = last->second;
  view.X_PC = place_of(view.patch)->X_WP.pose().inverse(Eigen::Isometry) * view.X_WC;
}

std::optional<PatchPlace> ViewRecord::place_of(std::int32_t patch) const {
  const auto header = headers_.find(patch);
  const auto moved = motions_.places().find(patch);
  if (header == headers_.end() && moved == motions_.places().end()) return std::nullopt;
  if (header == headers_.end()) return moved->second;
  if (moved == motions_.places().end()) return header->second;
  return moved->second.correction > header->second.correction ? moved->second : header->second;
}

ViewSet ViewRecord::views() const {
  ViewSet now = set_;
  for (KeptView& view : now.views) {
    const auto place = place_of(view.patch);
    if (place) {
      view.X_WC = place->X_WP.pose() * view.X_PC;
      view.part = place->part;
    }
  }
  return now;
}

}  // namespace kintsugi::segmenter
