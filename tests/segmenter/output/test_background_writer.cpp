#include <atomic>
#include <future>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/output/background_writer.hpp"
#include "segmenter/session/session_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

TEST(BackgroundWriter, DoesWhatWasHandedInBeforeItEnds) {
  std::atomic<int> done{0};
  {
    BackgroundWriter writer;
    for (int i = 0; i < 100; ++i) {
      writer.put(std::to_string(i), [&] { ++done; });
    }
  }
  EXPECT_EQ(done, 100);
}

TEST(BackgroundWriter, DoesOneJobAtATimeInOrder) {
  std::vector<int> order;  // of the writer's thread until wait()
  BackgroundWriter writer;
  for (int i = 0; i < 100; ++i) {
    writer.put(std::to_string(i), [&, i] { order.push_back(i); });
  }
  writer.wait();
  ASSERT_EQ(order.size(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(order));
  writer.wait();  // nothing to wait for
}

TEST(BackgroundWriter, ReplacesAWaitingJobOfTheSameName) {
  std::promise<void> disk;
  std::vector<std::string> done;
  BackgroundWriter writer;
  std::promise<void> begun;
  writer.put("map", [&] {
    begun.set_value();
    disk.get_future().wait();
    done.emplace_back("map 0");
  });
  begun.get_future().wait();
  writer.put("map", [&] { done.emplace_back("map 1"); });
  writer.put("other", [&] { done.emplace_back("other"); });
  writer.put("map", [&] { done.emplace_back("map 2"); });
  disk.set_value();
  writer.wait();
  EXPECT_EQ(done, (std::vector<std::string>{"map 0", "map 2", "other"}));
}

TEST(BackgroundWriter, SlicesAreSegmentedWhileAFileIsWritten) {
  std::promise<void> disk;
  const std::shared_future<void> disk_is_done = disk.get_future().share();
  std::vector<std::size_t> written;
  BackgroundWriter writer;
  int num_updates = 0;
  SessionMap::Config config;
  config.write_every = 1;
  const auto slices = testing::wavy_session(20, 50);
  SessionMap map(config, std::make_unique<SegmentMap>(SegmentMapConfig{}, 1, slices[0]));
  for (const CloudSlice& slice : slices) {
    map.offer(slice, {});
    const StepResult result = map.step({}, Outlook::kSilent);
    num_updates += static_cast<int>(result.updates.size());
    for (const SaveRequest& request : result.saves) {
      writer.put("map", [&, size = request.map->cloud().slices().size()] {
        disk_is_done.wait();
        written.push_back(size);
      });
    }
  }
  EXPECT_EQ(num_updates, 20);  // and no file is written yet
  disk.set_value();
  writer.wait();
  ASSERT_FALSE(written.empty());
  EXPECT_LE(written.size(), 2U + 20U);
  EXPECT_EQ(written.back(), 20U);
}

}  // namespace
}  // namespace kintsugi::segmenter
