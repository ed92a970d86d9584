#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/session/resumed_source.hpp"
#include "tests/mapper/source/empty_recording.hpp"

namespace kintsugi::mapper {
namespace {

using testing::EmptyRecording;

TEST(ResumedSource, GivesTheFramesThatWereMappedThenAndEachThereafter) {
  ResumedSource source(std::make_unique<EmptyRecording>(10), {10'000, 30'000, 40'000}, false);
  std::vector<std::int64_t> indices;
  while (const auto frame = source.next()) indices.push_back(frame->frame_index);
  EXPECT_EQ(indices, (std::vector<std::int64_t>{1, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(source.status().counts.frames_delivered, 8);
  EXPECT_EQ(source.status().counts.frames_dropped, 2);
  EXPECT_EQ(source.status().end_reason, "all given");
}

TEST(ResumedSource, EndsWhereTheSessionWasBeingEnded) {
  ResumedSource source(std::make_unique<EmptyRecording>(10), {0, 10'000}, true);
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
  EXPECT_FALSE(source.next());
  EXPECT_TRUE(source.status().ended_well);
  EXPECT_EQ(source.status().end_reason, "the session was ended here");
}

TEST(ResumedSource, RefusesARecordingWithoutAFrameThatWasMapped) {
  ResumedSource source(std::make_unique<EmptyRecording>(10), {0, 12'345}, false);
  EXPECT_TRUE(source.next());
  EXPECT_THROW(source.next(), std::runtime_error);
}

}  // namespace
}  // namespace kintsugi::mapper
