#include "mapper/conversion/calibration_writer.hpp"

#include <algorithm>
#include <iomanip>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::mapper {

void write_calibration(const std::filesystem::path& file, const Intrinsics& camera,
                       double depth_units_per_m) {
  AtomicFile text(file);
  std::ostream& out = text.stream();
  out << "# fx fy cx cy width height depth_scale [k1 k2 p1 p2 k3]\n" << std::setprecision(10);
  out << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy << ' '
      << camera.width << ' ' << camera.height << ' ' << depth_units_per_m;
  const bool is_distorted =
      std::ranges::any_of(camera.distortion, [](double term) { return term != 0.0; });
  if (is_distorted) {
    for (const double term : camera.distortion) out << ' ' << term;
  }
  out << '\n';
  text.commit();
}

}  // namespace kintsugi::mapper
