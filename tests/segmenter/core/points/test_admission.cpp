#include <limits>

#include <gtest/gtest.h>

#include "segmenter/core/points/admission.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

CloudPoint point(float x, float nz) {
  CloudPoint result;
  result.x = x;
  result.nz = nz;
  return result;
}

TEST(Admission, AdmitsPointsWithUnitNormals) {
  EXPECT_FALSE(reason_to_reject(point(0.0F, 1.0F)));
  EXPECT_FALSE(reason_to_reject(point(-1e6F, -1.0F)));
  EXPECT_FALSE(reason_to_reject(point(0.0F, 1.0F - kNormalLengthTolerance / 2)));
}

TEST(Admission, SaysWhyAPointIsRejected) {
  for (const float x : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(reason_to_reject(point(x, 1.0F)), "its position is not finite");
  }
  EXPECT_EQ(reason_to_reject(point(1.1e6F, 1.0F)),
            "its position is more than 1000 km from the origin");
  for (const float nz : {kNan, kInfinity}) {
    EXPECT_EQ(reason_to_reject(point(0.0F, nz)), "its normal is not finite");
  }
  for (const float nz : {0.0F, 0.5F, 1.1F, std::numeric_limits<float>::max()}) {
    EXPECT_EQ(reason_to_reject(point(0.0F, nz)), "its normal is not of unit length");
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
