#pragma once
// Kintsugi::segmentation: segments point clouds that grow, change and move, without mapper and bus.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// Names a piece of a map in a Segmenter; >= 0, never used again.
using PieceId = std::int32_t;

struct SegmenterOptions {
  double resolution_m = 0.01;      ///< spacing of the points (voxel size of the map), > 0
  std::string preset = "objects";  ///< "objects" or "paper"; segmenter/README.md has the values
  std::string mode = "exact";      ///< "exact", "voting" or "batch"
  /// Values that replace those of the preset, by name: threshold, scale, color_weight, min_points,
  /// beta, radius_factor.
  std::map<std::string, double> parameters{};
};

/// Where a piece is: p_W = X_WP * p_P. The pose is rounded to the floats of PatchPose.
struct PieceMove {
  PieceId piece = 0;
  Pose X_WP = Pose::Identity();
};

/// The segment map of a cloud that is given in pieces. After each change the segments equal those
/// of a batch segmentation of the whole cloud (mode `exact`), at the cost of what the change
/// touches; segments keep their ids as far as possible.
///
/// The points of a piece are in a frame P of its own, which is W until move() is called. A point
/// needs a position (metres), a unit normal towards free space, and a colour (black: none); weight
/// and reserved are 0 if nothing else is known. estimate_normals() computes normals. A point that
/// cannot be segmented (a coordinate that is not finite or beyond 1e6 m, a normal that is not of
/// unit length within 1 %) has the label kNoSegment and changes nothing else.
///
/// Every function that takes a piece throws std::invalid_argument when there is no such piece; then
/// nothing has changed. One thread at a time may use an object.
class [[gnu::visibility("default")]] Segmenter {
 public:
  /// @throws std::invalid_argument naming the option, its value and its bound
  explicit Segmenter(const SegmenterOptions& options);
  ~Segmenter();
  Segmenter(Segmenter && other) noexcept;
  Segmenter& operator=(Segmenter&& other) noexcept;

  /// Adds a piece, whose frame is W. It may have no points.
  PieceId add(std::span<const CloudPoint> points_W);
  /// Replaces the points of a piece, which stays where it is. A new point in the voxel of an old
  /// one counts as the same point, so that segments keep their ids.
  void replace(PieceId piece, std::span<const CloudPoint> points_P);
  /// Moves pieces in one run. Poses are absolute: two moves of a piece do not add up.
  /// @throws std::invalid_argument also when a piece is named twice, or a pose is not a rotation
  /// and
  ///   a translation of at most 1e6 m
  void move(std::span<const PieceMove> moves);
  void move(PieceId piece, const Pose& X_WP);
  /// Removes a piece and its points.
  void remove(PieceId piece);

  /// The pieces, ascending.
  [[nodiscard]] std::vector<PieceId> pieces() const;
  /// The segment of each point of a piece, in the order in which they were given; kNoSegment: it
  /// cannot be segmented.
  [[nodiscard]] std::vector<std::uint32_t> labels(PieceId piece) const;
  /// The points of a piece, where it is now, without those whose label is kNoSegment.
  [[nodiscard]] std::vector<CloudPoint> points_W(PieceId piece) const;
  /// Every segment, by ascending id.
  [[nodiscard]] std::vector<SegmentStatistics> segments() const;
  [[nodiscard]] std::int64_t num_points() const;  ///< without those that cannot be segmented
  [[nodiscard]] std::int64_t num_segments() const;

  // What the last change (add, replace, move, remove) did.
  /// Segments that came, went, were split or merged, or grew.
  [[nodiscard]] const std::vector<SegmentEvent>& events() const;
  /// The segments that changed and still exist, by ascending id.
  [[nodiscard]] const std::vector<SegmentStatistics>& changed_segments() const;
  /// The pieces whose labels() are others than before, ascending.
  [[nodiscard]] std::vector<PieceId> relabelled_pieces() const;

  /// Finds and describes segments: SegmentQuery tells where. Takes time proportional to the map.
  /// @throws std::invalid_argument naming a field that is out of its bounds, and for kPixel, which
  ///   needs a camera
  [[nodiscard]] SegmentAnswer ask(const SegmentQuery& query) const;

  /// Writes the map into a file that SavedMap, kintsugi-export and kintsugi-query read.
  /// @throws std::runtime_error naming the file and the reason
  void save(const std::filesystem::path& path) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A saved map: what Segmenter::save() or kintsugi-segmenter --save has written. It does not
/// change.
class [[gnu::visibility("default")]] SavedMap {
 public:
  /// @throws std::runtime_error naming the file, the place, the reason and what was expected
  explicit SavedMap(const std::filesystem::path& path);
  ~SavedMap();
  SavedMap(SavedMap && other) noexcept;
  SavedMap& operator=(SavedMap&& other) noexcept;

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] double resolution_m() const;
  [[nodiscard]] bool is_complete() const;  ///< the final slice and all others are in it
  /// All points, piece after piece; valid as long as this object.
  [[nodiscard]] std::span<const CloudPoint> points_W() const;
  /// The segment of each point; valid as long as this object.
  [[nodiscard]] std::span<const std::uint32_t> labels() const;
  /// Every segment, by ascending id.
  [[nodiscard]] const std::vector<SegmentStatistics>& segments() const;
  /// As Segmenter::ask().
  [[nodiscard]] SegmentAnswer ask(const SegmentQuery& query) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Sets the normal of every point with a finite position: principal components of the 20 nearest
/// neighbours, then the mean over neighbours closer than two voxels, as for the clouds of
/// kintsugi-segment-cloud. A point whose neighbours lie on a line gets the normal zero.
/// @param resolution_m spacing of the points, > 0 and at most 1e6
/// @param viewpoint_W where the sensor was: normals point towards it; nothing: the mean of all
///   points, which suits a room seen from inside
/// @throws std::invalid_argument for another resolution, or a viewpoint that is not finite
[[gnu::visibility("default")]] void estimate_normals(
    std::span<CloudPoint> points_W, double resolution_m,
    const std::optional<Eigen::Vector3d>& viewpoint_W = std::nullopt);

/// Scales normals to unit length; those that are zero or not finite stay as they are.
[[gnu::visibility("default")]] void normalize_normals(std::span<CloudPoint> points_W);

}  // namespace kintsugi
