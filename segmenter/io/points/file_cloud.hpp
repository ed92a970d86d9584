#pragma once
// The points of a file as the segmenter takes them, made from a table.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/io/points/point_roles.hpp"
#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// The points of a file, in its order; every per-point vector is as long as points_W, or empty
/// where the file has no such property.
struct FileCloud {
  std::vector<CloudPoint> points_W;         ///< properties the file lacks are zero
  std::vector<std::int32_t> slice_ids;      ///< order of arrival, >= 0
  std::vector<std::uint32_t> segment_ids;   ///< of a labelled cloud
  std::vector<std::uint8_t> in_volume;      ///< of a labelled cloud: 1: of a patch that may change
  std::vector<std::uint32_t> instance_ids;  ///< true instances, of a cloud for evaluation
  bool has_normals = false;
  std::vector<std::string> comments;  ///< of the header, in its order
};

/// How positions of a file become those of a cloud: metres_per_unit * p - origin_W.
struct PositionFrame {
  double metres_per_unit = 1.0;
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
};

/// An origin near the middle of the points, where they are so far from that of the file (1 km) that
/// float32 would lose 0.1 mm: their median, axis by axis, in whole hundreds of metres. Zero for
/// points nearer, and along an axis on which the median is beyond any place on earth (100,000 km).
Eigen::Vector3d choose_origin_W(const PointTable& table, const PointRoles& roles,
                                double metres_per_unit);

/// Positions become float32, colours 8 bits: real ones are given in 0..1, and 16 bits are scaled
/// unless all of the file's are below 256. Values that are not finite, or too large, are kept;
/// whether a point can be segmented is decided later (admission.hpp).
///
/// @throws std::runtime_error naming the file, the point and what was expected: a colour or an id
///   out of range
FileCloud cloud_of(const PointTable& table, const PointRoles& roles, const PositionFrame& frame,
                   const std::string& name);

}  // namespace kintsugi::segmenter
