#pragma once

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Where the camera is at the first frame of a part of the map, in W, until a loop says more. A
/// part begins where the camera was lost for long: nobody knows where it is relative to what was
/// mapped before. It lies so far from the others that no map reaches it, so that whoever reads the
/// map cannot mistake surface of one part for surface of another. There, floats are as fine as a
/// tenth of a millimetre.
inline Pose origin_of_part(int part) {
  constexpr double kDistance_m = 1'000.0;
  return Pose(Eigen::Translation3d(kDistance_m * part, 0.0, 0.0));
}

}  // namespace kintsugi::mapper
