#pragma once
// The ground truth of a segmentation: a cloud with the true instance of each point.

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/io/ply/ply_reader.hpp"

namespace kintsugi::segmenter {

struct TruthInstance {
  std::uint32_t id = 0;
  bool is_object = true;  ///< false: structure, such as floor, walls and ceiling
  std::string name;       ///< "" when unknown
};

/// Points of true surfaces and their instances; kNoInstance where unknown.
struct Truth {
  std::string source;                       ///< the file
  std::vector<CloudPoint> points_W;         ///< finite positions; nothing else of them matters
  std::vector<std::uint32_t> instance_ids;  ///< of each point
  std::vector<TruthInstance> instances;     ///< that have points, by ascending id

  std::set<std::uint32_t> objects() const;
};

/// From a PLY file with x y z and instance_id (any integer type; 0: unknown). Header lines `comment
/// instance ID structure|object NAME` give kind and name of either all instances or none; without
/// them all are objects. Points whose position is not finite are left out.
/// @param name stands for the file in errors
/// @throws std::runtime_error when there is no instance_id or no point, or when the lines name an
///   instance twice or lack one
Truth make_truth(const PlyCloud& cloud, const std::string& name);

/// @throws std::runtime_error as read_ply() and make_truth()
Truth read_truth(const std::filesystem::path& path);

/// The instance of the nearest point of the truth for each of `points_W`; kNoInstance where that is
/// farther than `max_distance_m`.
std::vector<std::uint32_t> instances_at(std::span<const CloudPoint> points_W, const Truth& truth,
                                        double max_distance_m);

}  // namespace kintsugi::segmenter
