#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/points/admission.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr MapConfig kSmall = {.num_points = 30'000, .num_rooms = 2};

TEST(GenerateMap, IsTheSameForTheSameConfigWhateverTheThreads) {
  const Slices slices = generate_map(kSmall);
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism,
                                               1);
  EXPECT_EQ(generate_map(kSmall), slices);
  MapConfig other = kSmall;
  other.seed = 2;
  EXPECT_NE(generate_map(other), slices);
}

TEST(GenerateMap, EndsWithTheSliceThatMakesItLargeEnough) {
  const Slices slices = generate_map(kSmall);
  ASSERT_GT(slices.size(), 3U);
  for (const auto& slice : slices) {
    EXPECT_THAT(slice.size(), ::testing::AllOf(::testing::Ge(1U), ::testing::Le(9000U)));
  }
  const std::size_t num_points = all_points(slices).size();
  EXPECT_GE(num_points, kSmall.num_points);
}

TEST(GenerateMap, MakesOnlyPointsThatCanBeSegmented) {
  std::set<std::array<float, 3>> places;
  for (const CloudPoint& p : all_points(generate_map(kSmall))) {
    ASSERT_EQ(reason_to_reject(p), std::nullopt);
    places.insert({p.x, p.y, p.z});
  }
  EXPECT_GT(places.size(), kSmall.num_points * 9 / 10);
}

TEST(GenerateMap, NamesFieldValueAndBound) {
  EXPECT_THAT([] { generate_map({.num_rooms = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("num_rooms")));
  EXPECT_THAT([] { generate_map({.noise = -1.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("noise is -1")));
}

class ReadMap : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::vector<std::uint64_t>& header,
                              const std::vector<float>& values) const {
    auto file = folder_.path() / "map.bin";
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(header.data()),
              static_cast<std::streamsize>(8 * header.size()));
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(4 * values.size()));
    return file;
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST_F(ReadMap, TakesSlicesFromABinary) {
  const Slices slices = read_map(write({2, 0, 1, 1}, {1, 2, 3, 0, 0, 1}));
  ASSERT_EQ(slices.size(), 2U);
  ASSERT_EQ(slices[0].size(), 1U);
  EXPECT_EQ(slices[0][0].z, 3.0F);
  EXPECT_EQ(slices[0][0].nz, 1.0F);
  EXPECT_TRUE(slices[1].empty());
}

TEST_F(ReadMap, RefusesADamagedBinary) {
  const auto refused = [](const std::filesystem::path& file) { return [=] { read_map(file); }; };
  EXPECT_THAT(refused(write({2, 0, 1, 2}, {1, 2, 3, 0, 0, 1})),
              ThrowsMessage<std::runtime_error>(HasSubstr("ends early")));
  EXPECT_THAT(refused(write({1, 0}, {})),
              ThrowsMessage<std::runtime_error>(HasSubstr("ends early")));
  EXPECT_THAT(refused(write({1ULL << 60U}, {})),
              ThrowsMessage<std::runtime_error>(HasSubstr("cannot hold")));
  EXPECT_THAT(refused(write({1, 1, 0}, {})),
              ThrowsMessage<std::runtime_error>(HasSubstr("slices overlap")));
  EXPECT_THAT(refused(write({1, 0, 1ULL << 60U}, {})),
              ThrowsMessage<std::runtime_error>(HasSubstr("points")));
}

}  // namespace
}  // namespace kintsugi::segmenter::bench
