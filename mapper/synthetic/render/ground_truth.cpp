#include "mapper/synthetic/render/ground_truth.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <string>

#include <nlohmann/json.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "mapper/synthetic/render/instance_json.hpp"

namespace kintsugi::synthetic {

namespace {

void write_poses(const Sequence& sequence, const std::filesystem::path& path) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << "# X_WC of synthetic://" << sequence.config().scene
      << ": W is the scene's frame, z up, metres\n"
      << "# timestamp tx ty tz qx qy qz qw\n"
      << std::fixed;
  for (int frame = 0; frame < sequence.num_frames(); ++frame) {
    const Pose X_WC = sequence.X_WC(frame);
    const Eigen::Vector3d p = X_WC.translation();
    const Eigen::Quaterniond q(X_WC.linear());
    const std::int64_t utime = sequence.utime(frame);
    out << utime / 1'000'000 << '.' << std::setw(6) << std::setfill('0') << utime % 1'000'000
        << std::setprecision(9);
    for (double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) out << ' ' << value;
    out << '\n';
  }
  file.commit();
}

void write_camera(const Intrinsics& camera, const std::filesystem::path& path) {
  constexpr int kDepthUnitsPerMetre = 1000;
  AtomicFile file(path);
  file.stream() << "# fx fy cx cy width height depth_scale\n"
                << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy << ' '
                << camera.width << ' ' << camera.height << ' ' << kDepthUnitsPerMetre << '\n';
  file.commit();
}

void write_instances(const Scene& scene, const std::filesystem::path& path) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Instance& instance : scene.instances()) {
    const auto level = [&](int channel) {
      return static_cast<int>(std::lround(255.0F * instance.color[channel]));
    };
    const auto solids = std::count_if(
        scene.primitives().begin(), scene.primitives().end(),
        [&](const Primitive& primitive) { return primitive.instance == instance.id; });
    list.push_back({{"id", instance.id},
                    {"name", instance.name},
                    {"model", instance.model},
                    {"key", instance.key},
                    {"shape", instance.shape},
                    {"color", {level(0), level(1), level(2)}},
                    {"solids", solids},
                    {"is_structure", instance.is_structure},
                    {"X_SG", numbers_of(instance.X_WG)},
                    {"symmetry", symmetry_json(instance, scene)}});
  }
  AtomicFile file(path);
  file.stream() << nlohmann::ordered_json{{"instances", list}}.dump(1) << '\n';
  file.commit();
}

}  // namespace

void write_ground_truth(const Sequence& sequence, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_poses(sequence, folder / "groundtruth.txt");
  write_camera(sequence.intrinsics(), folder / "camera.txt");
  write_instances(sequence.scene(), folder / "instances.json");
}

}  // namespace kintsugi::synthetic
