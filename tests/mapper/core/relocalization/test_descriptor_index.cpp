#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/relocalization/descriptor_index.hpp"

namespace kintsugi::mapper {
namespace {

cv::Mat_<std::uint8_t> random_descriptors(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  cv::Mat_<std::uint8_t> descriptors(count, 32);
  for (std::uint8_t& byte : descriptors) byte = static_cast<std::uint8_t>(random());
  return descriptors;
}

/// Flips this many bits of each row.
cv::Mat_<std::uint8_t> with_noise(const cv::Mat_<std::uint8_t>& descriptors, int bits) {
  std::mt19937 random(99);
  cv::Mat_<std::uint8_t> noisy = descriptors.clone();
  for (int row = 0; row < noisy.rows; ++row) {
    for (int i = 0; i < bits; ++i) {
      const auto bit = static_cast<int>(random() % 256);
      noisy(row, bit / 8) ^= static_cast<std::uint8_t>(1U << (bit % 8));
    }
  }
  return noisy;
}

TEST(DescriptorIndex, FindsTheImageThatSharesFeatures) {
  DescriptorIndex index;
  for (int image = 0; image < 20; ++image) index.add(random_descriptors(200, image));
  const auto matches = index.count_matches(random_descriptors(200, 7));
  ASSERT_EQ(matches.size(), 20U);
  for (int image = 0; image < 20; ++image) EXPECT_EQ(matches[image], image == 7 ? 200 : 0);
}

TEST(DescriptorIndex, ForgivesSomeBits) {
  DescriptorIndex index;
  index.add(random_descriptors(400, 1));
  index.add(random_descriptors(400, 2));
  // With 12 of 256 bits flipped, a key of 20 bits survives with (1 - 12/256)^20 = 0.38, one of
  // four with 0.85.
  const auto matches = index.count_matches(with_noise(random_descriptors(400, 2), 12));
  EXPECT_EQ(matches[0], 0);
  EXPECT_NEAR(matches[1], 0.85 * 400, 40);  // 5 standard deviations of 7, and keys share bits
}

TEST(DescriptorIndex, CountsADescriptorOnceForAnImage) {
  cv::Mat_<std::uint8_t> same;
  for (int i = 0; i < 5; ++i) same.push_back(random_descriptors(1, 3));
  DescriptorIndex index;
  index.add(same);
  EXPECT_THAT(index.count_matches(random_descriptors(1, 3)), ::testing::ElementsAre(1));
}

TEST(DescriptorIndex, TakesImagesWithoutFeatures) {
  DescriptorIndex index;
  index.add({});
  index.add(random_descriptors(3, 1));
  EXPECT_THAT(index.count_matches(random_descriptors(3, 1)), ::testing::ElementsAre(0, 3));
  EXPECT_THAT(index.count_matches({}), ::testing::ElementsAre(0, 0));
}

}  // namespace
}  // namespace kintsugi::mapper
