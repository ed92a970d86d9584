#include "tests/viewer/support/patched_room.hpp"

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "viewer/core/map/point_chunk.hpp"
#include "viewer/core/rendering/shade.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kTile_m = 0.5;
constexpr int kFramesPerBatch = 7;  // about four batches a second
constexpr int kFramesPerView = 3;
constexpr int kDepthStep = 4;
const Intrinsics kCamera{
    .fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480};

using Tile = std::array<int, 3>;

struct SeenPoint {
  CloudPoint point;
  std::uint32_t label = 0;
  bool is_seen = false;
};

struct Patch {
  std::vector<SeenPoint> points;
  std::size_t num_seen = 0;
  std::size_t num_sent = 0;
  CloudSlice slice;  // the newest revision
};

/// The camera's picture at `step` times fewer pixels along each axis.
VirtualCamera camera_of(const Pose& X_WC, int step) {
  Intrinsics k = kCamera;
  k.fx /= step;
  k.fy /= step;
  const int first = step / 2;
  k.cx = (k.cx - first) / step;
  k.cy = (k.cy - first) / step;
  k.width /= step;
  k.height /= step;
  return {k, X_WC};
}

class PatchedRoom {
 public:
  PatchedRoom(double length_m, double resolution_m) : room_(make_room(length_m, resolution_m)) {
    for (std::size_t i = 0; i < room_.slices.size(); ++i) {
      for (std::size_t j = 0; j < room_.slices[i].points_W.size(); ++j) {
        const CloudPoint& p = room_.slices[i].points_W[j];
        const auto tile = [](float x) { return static_cast<int>(std::floor(x / kTile_m)); };
        tiles_[{tile(p.x), tile(p.y), tile(p.z)}].points.push_back({p, room_.updates[i].labels[j]});
        all_W_.push_back(p);
        labels_.push_back(room_.updates[i].labels[j]);
      }
    }
    for (std::size_t first = 0; first < all_W_.size(); first += PointChunk::kMaxPoints) {
      const std::size_t count = std::min(PointChunk::kMaxPoints, all_W_.size() - first);
      const std::span points_W = std::span(all_W_).subspan(first, count);
      chunks_.push_back({points_W, std::span(labels_).subspan(first, count),
                         chunk_boxes_of(points_W).front(), static_cast<float>(resolution_m)});
    }
  }

  SyntheticMap take() {
    for (std::size_t i = 0; i < room_.poses.size(); ++i) {
      if (i % kFramesPerView == 0) add_view(room_.poses[i]);
      if (i % kFramesPerBatch == kFramesPerBatch - 1) add_batch(room_.poses[i], false);
    }
    add_batch(room_.poses.back(), true);
    add_final(room_.poses.back());
    map_.poses = std::move(room_.poses);
    return std::move(map_);
  }

 private:
  CloudSlice header(const CameraPose& pose) const {
    CloudSlice slice = room_.slices.front();
    slice.points_W.clear();
    slice.utime = pose.utime;
    slice.X_WC = pose.X_WC;
    return slice;
  }

  void add_view(const CameraPose& pose) {
    CameraView view;
    view.utime = pose.utime;
    view.session = pose.session;
    view.map_name = room_.slices.front().map_name;
    view.frame_index = pose.frame_index;
    view.state = pose.state;
    view.X_WC = pose.X_WC;
    view.intrinsics = kCamera;
    view.depth_step = kDepthStep;
    const VisibilityImage depth = splat_points(chunks_, camera_of(pose.X_WC, kDepthStep), {});
    for (int v = 0; v < depth.height(); ++v) {
      for (int u = 0; u < depth.width(); ++u) {
        const double depth_m = depth.empty(u, v) ? 0.0 : depth.depth_m(u, v);
        view.depth_mm.push_back(static_cast<std::uint16_t>(std::lround(1000.0 * depth_m)));
      }
    }
    const VirtualCamera color_camera = camera_of(pose.X_WC, 2);
    const cv::Mat3b color =
        shade(splat_points(chunks_, color_camera, {}), chunks_, color_camera, Coloring::kTrue);
    cv::imencode(".jpg", color, view.color_jpeg);
    map_.views.push_back(std::move(view));
  }

  /// The points that the camera sees at this pose are seen from now on.
  void see(const Pose& X_WC) {
    const VirtualCamera camera = camera_of(X_WC, 2);
    const VisibilityImage visible = splat_points(chunks_, camera, {});
    const Pose X_CW = X_WC.inverse();
    for (auto& [tile, patch] : tiles_) {
      for (SeenPoint& seen : patch.points) {
        const CloudPoint& p = seen.point;
        const Eigen::Vector3d p_C = X_CW * Eigen::Vector3d(p.x, p.y, p.z);
        if (seen.is_seen || p_C.z() < 0.4 || p_C.z() > 4.0) continue;
        const Intrinsics& k = camera.intrinsics;
        const int u = static_cast<int>(std::lround(k.fx * p_C.x() / p_C.z() + k.cx));
        const int v = static_cast<int>(std::lround(k.fy * p_C.y() / p_C.z() + k.cy));
        if (u < 0 || v < 0 || u >= k.width || v >= k.height || visible.empty(u, v)) continue;
        if (p_C.z() > visible.depth_m(u, v) + 0.05) continue;
        seen.is_seen = true;
        ++patch.num_seen;
      }
    }
  }

  void add_batch(const CameraPose& pose, bool is_last) {
    see(pose.X_WC);
    const std::size_t first = map_.slices.size();
    for (auto& [tile, patch] : tiles_) {
      const bool has_grown = patch.num_seen > patch.num_sent + patch.num_sent / 4;
      if (patch.num_seen == 0 || !(has_grown || is_last)) continue;
      send(patch, pose, !is_last);
    }
    if (map_.slices.size() > first) map_.slices.back().ends_batch = true;
  }

  void send(Patch& patch, const CameraPose& pose, bool in_volume) {
    CloudSlice slice = header(pose);
    slice.kind = SliceKind::kPatch;
    slice.in_volume = in_volume;
    const bool is_new = patch.num_sent == 0;
    slice.id = is_new ? num_patches_++ : patch.slice.id;
    slice.revision = is_new ? 0 : patch.slice.revision + 1;
    revision_sum_ += is_new ? 0 : 1;
    SegmentUpdate update = room_.updates.front();
    update.labels.clear();
    for (const SeenPoint& seen : patch.points) {
      if (!seen.is_seen) continue;
      slice.points_W.push_back(seen.point);
      update.labels.push_back(seen.label);
      ids_.insert(seen.label);
    }
    patch.num_sent = patch.num_seen;
    patch.slice = slice;
    add(std::move(slice), std::move(update));
  }

  void add(CloudSlice slice, SegmentUpdate update) {
    update.utime = slice.utime;
    update.slice_id = slice.id;
    update.slice_revision = slice.revision;
    update.sequence = std::ssize(map_.updates);
    update.is_final = slice.kind == SliceKind::kFinal;
    update.num_slices = num_patches_;
    update.num_segments = std::ssize(ids_);
    map_.slices.push_back(std::move(slice));
    map_.updates.push_back(std::move(update));
  }

  void add_final(const CameraPose& pose) {
    CloudSlice slice = header(pose);
    slice.kind = SliceKind::kFinal;
    slice.id = num_patches_++;
    slice.revision_sum = revision_sum_;
    SegmentUpdate update = room_.updates.front();
    update.labels.clear();
    add(std::move(slice), std::move(update));
  }

  SyntheticMap room_;
  std::map<Tile, Patch> tiles_;
  std::vector<CloudPoint> all_W_;
  std::vector<std::uint32_t> labels_;
  std::vector<PointChunk> chunks_;
  SyntheticMap map_;
  std::set<std::uint32_t> ids_;
  std::int32_t num_patches_ = 0;
  std::int64_t revision_sum_ = 0;
};

}  // namespace

SyntheticMap make_patched_room(double length_m, double resolution_m) {
  return PatchedRoom(length_m, resolution_m).take();
}

}  // namespace kintsugi::viewer
