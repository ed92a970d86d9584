#pragma once

#include <algorithm>
#include <cstdlib>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Where the camera is at the first frame of a part of the map, in W, until a loop says more. A
/// part begins where the camera was lost for long: nobody knows where it is relative to what was
/// mapped before. It lies so far from the others that no map reaches it, so that whoever reads the
/// map cannot mistake surface of one part for surface of another.
///
/// The parts are on a grid, from its middle outwards, so that coordinates are small: floats are as
/// fine as a tenth of a millimetre in the first 27 parts, as half a millimetre in the first 1,331.
inline Pose origin_of_part(int part) {
  constexpr double kDistance_m = 1'000.0;
  const auto cube = [](int shell) { return (2 * shell + 1) * (2 * shell + 1) * (2 * shell + 1); };
  int first = 0;
  while (cube(first) <= part) ++first;
  int count = first == 0 ? 0 : cube(first - 1);
  for (int shell = first;; ++shell) {  // the surface of a cube
    for (int x = shell; x >= -shell; --x) {
      for (int y = shell; y >= -shell; --y) {
        for (int z = shell; z >= -shell; --z) {
          if (std::max({std::abs(x), std::abs(y), std::abs(z)}) < shell) continue;
          if (count++ == part)
            return Pose(Eigen::Translation3d(kDistance_m * Eigen::Vector3d(x, y, z)));
        }
      }
    }
  }
}

}  // namespace kintsugi::mapper
