#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "viewer/core/map/label_update.hpp"
#include "viewer/core/map/point_chunk.hpp"

namespace kintsugi::viewer {

/// One slice of the map with the labels that it has so far. Every point remembers the number of the
/// update that labelled it, and an update never overrides one with a higher number: so the labels
/// do not depend on the order in which updates arrive.
class MapSlice {
 public:
  /// `place`: where its points are (PatchMotions::place_of()).
  MapSlice(CloudSlice slice, const PatchPlace& place);

  /// Moves the points of a patch, unless it is where a newer correction has put it. The same in
  /// every order of corrections.
  void move_to(const PatchPlace& place);

  std::int64_t utime() const { return utime_; }
  std::int32_t id() const { return id_; }
  std::int32_t revision() const { return revision_; }
  /// The part of the map in which its points are by now.
  std::int32_t part() const { return place_.part; }
  /// Of the camera, in the part that the slice was sent for: a correction does not move it.
  const Pose& X_WC() const { return X_WC_; }
  std::int32_t part_of_camera() const { return part_of_camera_; }
  /// It may still change, as long as the mapper observes it.
  bool in_volume() const { return in_volume_; }
  const std::vector<CloudPoint>& points_W() const { return points_W_; }
  const std::vector<std::uint32_t>& labels() const { return labels_; }
  float resolution_m() const { return resolution_m_; }
  /// The points in the frame P of the patch, and where P is: what a correction changes is the pose.
  const std::vector<CloudPoint>& points_P() const {
    return points_P_.empty() ? points_W_ : points_P_;
  }
  PatchPose X_WP() const { return points_P_.empty() ? PatchPose() : place_.X_WP; }
  /// Grows whenever a label changes.
  std::uint64_t label_changes() const { return label_changes_; }
  void append_chunks(std::vector<PointChunk>& chunks) const;

  /// The update with this slice's labels has been applied, from the present segmenter.
  bool is_labelled() const { return is_labelled_; }
  /// The same, from the present segmenter or an earlier one.
  bool was_labelled() const { return was_labelled_; }

  /// The labels of all points. kNotUsable when there are not as many labels as points.
  UpdateEffect apply(const NumberedLabels& update);
  /// One label for a range of points. kNotUsable when it is empty or reaches outside the slice.
  UpdateEffect apply(const NumberedRun& update);

  /// Keeps the labels until any update of a new segmenter replaces them.
  void await_new_segmenter();
  /// Removes labels of earlier segmenters, if the present one has not sent this slice's update.
  void discard_old_labels();

 private:
  void put(const PatchPlace& place);
  bool set_label(std::size_t point, std::uint32_t segment_id, std::uint32_t update_number);

  std::int64_t utime_;
  std::int32_t id_;
  std::int32_t revision_;
  bool in_volume_;
  float resolution_m_;
  Pose X_WC_;
  std::int32_t part_of_camera_;
  bool is_patch_;
  PatchPlace place_;
  std::vector<CloudPoint> points_P_;  // as received; empty where P is W
  std::vector<CloudPoint> points_W_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint32_t> label_updates_;  // 1 + number of the update behind each label; 0: none
  std::uint64_t label_changes_ = 0;
  std::vector<Eigen::AlignedBox3f> chunk_boxes_W_;
  bool is_labelled_ = false;
  bool was_labelled_ = false;
};

}  // namespace kintsugi::viewer
