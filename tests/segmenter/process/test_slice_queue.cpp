#include <thread>

#include <gtest/gtest.h>

#include "segmenter/process/slice_queue.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;

CloudSlice slice_of(std::size_t num_points) {
  CloudSlice slice;
  slice.points_W.resize(num_points);
  return slice;
}

TEST(SliceQueue, CountsWhatIsQueuedAndWhatWaits) {
  const std::size_t bytes = bytes_of(slice_of(10));
  SliceQueue queue(10 * bytes);
  queue.push(slice_of(10));
  queue.push(slice_of(10));
  EXPECT_EQ(queue.size(), 2);
  EXPECT_EQ(queue.bytes(), 2 * bytes);
  EXPECT_EQ(queue.take(milliseconds(0)).size(), 2U);
  EXPECT_EQ(queue.size(), 0);
  EXPECT_EQ(queue.bytes(), 2 * bytes);  // until it is said that less waits
  queue.set_waiting(bytes, false);
  EXPECT_EQ(queue.bytes(), bytes);
}

TEST(SliceQueue, HasNoRoomWhenFullExceptForWhatEverythingWaitsFor) {
  SliceQueue queue(bytes_of(slice_of(10)));
  EXPECT_EQ(queue.room(), StreamRoom::kPlenty);
  queue.push(slice_of(10));
  EXPECT_EQ(queue.room(), StreamRoom::kNone);
  queue.set_waiting(0, true);
  EXPECT_EQ(queue.room(), StreamRoom::kNone);  // what is queued may be what is missing
  const auto taken = queue.take(milliseconds(0));
  EXPECT_EQ(queue.room(), StreamRoom::kOnlyNext);
  queue.set_waiting(bytes_of(taken[0]), false);
  EXPECT_EQ(queue.room(), StreamRoom::kNone);
  queue.set_waiting(0, false);
  EXPECT_EQ(queue.room(), StreamRoom::kPlenty);
}

TEST(SliceQueue, AReaderWaitsForRoom) {
  SliceQueue queue(1);
  queue.push(slice_of(1));
  EXPECT_FALSE(queue.wait_for_room(milliseconds(1)));
  std::thread worker([&] {
    queue.take(milliseconds(0));
    queue.set_waiting(0, false);
  });
  EXPECT_TRUE(queue.wait_for_room(std::chrono::hours(1)));
  worker.join();
}

// Else it would wait for what only it can bring.
TEST(SliceQueue, AReaderGoesOnWhenTheEndOfABatchIsStillToBeRead) {
  SliceQueue queue(1);
  queue.push(slice_of(1));
  queue.set_waiting(0, true, true);
  EXPECT_FALSE(queue.wait_for_room(milliseconds(1)));  // what is queued may be the end
  const auto taken = queue.take(milliseconds(0));
  queue.set_waiting(bytes_of(taken[0]), true, true);
  EXPECT_TRUE(queue.wait_for_room(milliseconds(0)));
  queue.push(slice_of(1));
  EXPECT_FALSE(queue.wait_for_room(milliseconds(1)));
  queue.take(milliseconds(0));
  queue.set_waiting(2 * bytes_of(taken[0]), true, false);
  EXPECT_FALSE(queue.wait_for_room(milliseconds(1)));
}

TEST(SliceQueue, IsExhaustedWhenClosedAndEmpty) {
  SliceQueue queue(1);
  queue.push(slice_of(1));
  queue.close();
  EXPECT_FALSE(queue.is_exhausted());
  queue.take(std::chrono::hours(1));
  EXPECT_TRUE(queue.is_exhausted());
  EXPECT_TRUE(queue.take(std::chrono::hours(1)).empty());  // waits for nothing
}

TEST(SliceQueue, AWaitForSlicesEndsWhenItIsWoken) {
  SliceQueue queue(1);
  queue.wake();  // before the wait begins
  EXPECT_TRUE(queue.take(std::chrono::hours(1)).empty());
}

}  // namespace
}  // namespace kintsugi::segmenter
