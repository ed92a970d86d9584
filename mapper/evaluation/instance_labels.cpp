#include "mapper/evaluation/instance_labels.hpp"

#include <cmath>
#include <string>

#include <oneapi/tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/ply_writer.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::mapper {
namespace {

std::vector<std::string> instance_comments(const synthetic::Scene& scene) {
  std::vector<std::string> comments;
  comments.reserve(scene.instances().size());
  for (const synthetic::Instance& instance : scene.instances()) {
    const char* const kind = instance.is_structure ? "structure " : "object ";
    comments.push_back("instance " + std::to_string(instance.id) + ' ' + kind + instance.name);
  }
  return comments;
}

}  // namespace

std::vector<std::uint32_t> nearest_instances(const std::vector<CloudPoint>& points_W,
                                             const synthetic::Scene& scene, const Pose& X_SW,
                                             double max_distance_m) {
  require(max_distance_m > 0.0, "nearest_instances: max_distance_m", max_distance_m,
          "greater than 0");
  std::vector<std::uint32_t> labels(points_W.size());
  tbb::parallel_for(std::size_t{0}, points_W.size(), [&](std::size_t i) {
    const CloudPoint& p = points_W[i];
    const auto nearest = scene.nearest_surface(X_SW * Eigen::Vector3d(p.x, p.y, p.z));
    const bool is_near = std::abs(nearest.signed_m) <= max_distance_m;
    labels[i] = static_cast<std::uint32_t>(is_near ? nearest.instance : synthetic::kNoInstance);
  });
  return labels;
}

void write_instance_cloud(const std::filesystem::path& path,
                          const std::vector<CloudPoint>& points_W,
                          const std::vector<std::uint32_t>& labels, const synthetic::Scene& scene) {
  require(labels.size() == points_W.size(), "write_instance_cloud: number of labels", labels.size(),
          "the number of points, " + std::to_string(points_W.size()));
  PlyWriter file(
      path,
      {{"vertex", {"float x", "float y", "float z", "uint instance_id"}, std::ssize(points_W)}},
      instance_comments(scene));
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    file.append(0, points_W[i].x, points_W[i].y, points_W[i].z, labels[i]);
  }
  file.commit();
}

}  // namespace kintsugi::mapper
