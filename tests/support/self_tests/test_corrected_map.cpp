#include <algorithm>
#include <map>

#include <gmock/gmock.h>

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "tests/support/corrected_map.hpp"
#include "tests/support/message_equality.hpp"

namespace kintsugi::testing {
namespace {

const PlayedMap& small_map() {
  static const PlayedMap map(
      {.session = 7, .map_name = "played", .num_points = 30'000, .most_points = 1'000});
  return map;
}

std::vector<CloudSlice> all_slices(const CorrectedMap& map) {
  std::vector<CloudSlice> slices;
  for (std::size_t step = 0; step < map.num_steps(); ++step) slices.push_back(map.slice(step));
  return slices;
}

TEST(CorrectedMap, IsASessionThatIsNumberedWithoutGapsAndTellsItsRevisions) {
  const auto slices = all_slices({small_map(), {.num_corrections = 3, .batch_patches = 4}});
  std::map<std::int32_t, std::int32_t> newest;
  std::int32_t num_corrections = 0;
  for (const CloudSlice& slice : slices) {
    EXPECT_GE(num_chunks(slice, kDefaultMaxChunkBytes), 1) << "not fit to be published";
    const bool is_new = newest.emplace(slice.id, slice.revision).second;
    EXPECT_EQ(is_new, slice.revision == 0);
    if (is_new) {
      EXPECT_EQ(slice.id, std::ssize(newest) - 1);
    }
    newest[slice.id] = slice.revision;
    if (slice.kind == SliceKind::kCorrection) ++num_corrections;
    if (slice.kind != SliceKind::kFinal) {
      EXPECT_EQ(slice.correction, num_corrections);
    }
  }
  EXPECT_EQ(num_corrections, 3);
  std::int64_t revision_sum = 0;
  for (const auto& [id, revision] : newest) revision_sum += revision;
  EXPECT_GT(revision_sum, 0);
  EXPECT_EQ(slices.back().kind, SliceKind::kFinal);
  EXPECT_EQ(slices.back().revision_sum, revision_sum);
}

TEST(CorrectedMap, ItsLastCorrectionMovesAllPatchesButTheFirst) {
  const auto slices = all_slices({small_map(), {.num_corrections = 2, .batch_patches = 4}});
  const auto last =
      std::ranges::find(slices.rbegin(), slices.rend(), SliceKind::kCorrection, &CloudSlice::kind);
  ASSERT_NE(last, slices.rend());
  EXPECT_EQ(std::ssize(last->motions), small_map().num_slices() - 2);
  PatchMotions places;
  for (const CloudSlice& slice : slices) {
    if (slice.kind == SliceKind::kCorrection) {
      EXPECT_EQ(places.learn(slice).size(), slice.motions.size()) << "each is newer";
    }
  }
  const CloudSlice& revised = slices[slices.size() - 2];
  EXPECT_GT(revised.revision, 0);
  EXPECT_EQ(places.places().at(revised.id).X_WP, revised.X_WP) << "header and correction agree";
}

TEST(CorrectedMap, IsTheSameEachTime) {
  const CorrectedMap::Config config{.num_corrections = 2, .batch_patches = 4};
  EXPECT_EQ(all_slices({small_map(), config}), all_slices({small_map(), config}));
}

}  // namespace
}  // namespace kintsugi::testing
