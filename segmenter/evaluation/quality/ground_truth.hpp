#pragma once
// A cloud of which it is known what each point belongs to.

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
  std::string name;       ///< "" where nobody says
};

/// Points of true surfaces and their instances, kNoInstance where it is not known.
struct Truth {
  std::string source;                       ///< the file
  std::vector<CloudPoint> points_W;         ///< finite positions; nothing else of them matters
  std::vector<std::uint32_t> instance_ids;  ///< of each point
  std::vector<TruthInstance> instances;     ///< that have points, by ascending id

  std::set<std::uint32_t> objects() const;
};

/// Of a PLY file with x y z and instance_id (any integer type; 0: not known). Header lines `comment
/// instance ID structure|object NAME` say what an instance is, for all of them or none: then all
/// are objects. Points whose position is not finite are left out.
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
