#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/evaluation/agreement/agreement.hpp"

namespace kintsugi::segmenter {
namespace {

using Labels = std::vector<std::uint32_t>;

TEST(MutualOverlap, OfAPartitionWithItselfIsOneWhateverTheNames) {
  const auto agreements = mutual_overlap(Labels{7, 7, 3, 9, 3}, Labels{0, 0, 5, 1, 5});
  ASSERT_EQ(agreements.size(), 3U);
  for (const SegmentAgreement& segment : agreements) EXPECT_EQ(segment.v, 1.0);
  EXPECT_EQ(agreements[0].label, 3U);
  EXPECT_EQ(agreements[2].label, 9U);
  EXPECT_EQ(agreements[0].num_points, 2);
}

TEST(MutualOverlap, TakesTheSmallerOfBothShares) {
  // Segment 1 of 4 points: 3 of the 6 points of reference 8, and the whole of reference 9.
  const auto agreements = mutual_overlap(Labels{1, 1, 1, 1, 2, 2, 2}, Labels{8, 8, 8, 9, 8, 8, 8});
  ASSERT_EQ(agreements.size(), 2U);
  EXPECT_EQ(agreements[0].v, 3.0 / 6.0);  // reference 9 would give 1 / 4
  EXPECT_EQ(agreements[1].v, 3.0 / 6.0);
}

TEST(MutualOverlap, TheLargestIntersectionIsNotAlwaysTheBest) {
  // Segment 0 shares 3 points with a reference of 10, but 2 points with one of 2.
  const auto agreements = mutual_overlap(Labels{0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1},
                                         Labels{4, 4, 4, 5, 5, 4, 4, 4, 4, 4, 4, 4});
  EXPECT_EQ(agreements[0].v, 2.0 / 5.0);
  EXPECT_EQ(agreements[1].v, 7.0 / 10.0);
}

TEST(MutualOverlap, RefusesPartitionsOfDifferentPoints) {
  EXPECT_THROW(mutual_overlap(Labels{1, 2}, Labels{1}), std::invalid_argument);
}

TEST(Summarize, WeighsBySegmentsAndByPoints) {
  const std::vector<SegmentAgreement> agreements = {{1, 1, 1.0}, {2, 3, 0.5}, {3, 4, 1.0}};
  const AgreementSummary all = summarize(agreements);
  EXPECT_EQ(all.num_segments, 3);
  EXPECT_EQ(all.num_points, 8);
  EXPECT_DOUBLE_EQ(all.exact_share, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(all.exact_point_share, 5.0 / 8.0);
  EXPECT_DOUBLE_EQ(all.mean_v, 2.5 / 3.0);
  EXPECT_DOUBLE_EQ(all.point_mean_v, 6.5 / 8.0);

  const AgreementSummary large = summarize(agreements, 3);
  EXPECT_EQ(large.num_segments, 2);
  EXPECT_DOUBLE_EQ(large.exact_share, 0.5);
  EXPECT_DOUBLE_EQ(large.exact_point_share, 4.0 / 7.0);
}

TEST(Summarize, OfNothingIsZero) {
  const AgreementSummary none = summarize(mutual_overlap(Labels{}, Labels{}));
  EXPECT_EQ(none.num_segments, 0);
  EXPECT_EQ(none.mean_v, 0.0);
}

}  // namespace
}  // namespace kintsugi::segmenter
