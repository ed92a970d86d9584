// Questions to a segmenter over a real bus, in a network namespace of the test's own.

#include <atomic>
#include <cmath>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/saved_map.hpp"
#include "segmenter/query/answer.hpp"
#include "segmenter/tools/query/query_client.hpp"
#include "tests/segmenter/process/listener.hpp"
#include "tests/segmenter/process/room_session.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/message_equality.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::kPrivateBusUrl;
using kintsugi::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Listener;
using testing::on_the_bus;
using Seconds = QueryClient::Seconds;

class QueryOnTheBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
  static SegmentQuery largest(int count) {
    SegmentQuery query;
    query.max_segments = count;
    return query;
  }
  static std::vector<CloudSlice> named(std::vector<CloudSlice> slices, const std::string& name) {
    for (CloudSlice& slice : slices) slice.map_name = name;
    return slices;
  }
  testing::ProgramResult run_query(const std::string& arguments) const {
    return testing::run_program("kintsugi-query",
                                "--lcm-url '" + std::string(kPrivateBusUrl) + "' " + arguments,
                                folder_ / "query.txt");
  }

  TemporaryFolder folder_;
};

TEST_F(QueryOnTheBus, AnswersWithTheMapAsItIsBetweenSlicesAndAfterThem) {
  const auto slices = testing::RoomRow(1, 0.04).cut(0.5);
  SegmentMap expected(SegmentMapConfig{}, 1, slices.front());
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.exit_on_final = false;
  Listener listener(config);
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  QueryClient client(kPrivateBusUrl);
  for (const CloudSlice& slice : slices) {
    publisher.publish(slice);
    expected.add({&slice, 1});
    ASSERT_TRUE(
        listener.hears([&] { return listener.last && listener.last->slice_id == slice.id; }));
    SegmentAnswer answered = client.ask(largest(4), Seconds(60));
    EXPECT_EQ(answered.problem, "");
    EXPECT_GT(answered.utime, 0);
    SegmentQuery query = largest(4);
    query.client = answered.client;
    query.number = answered.number;
    SegmentAnswer right = answer(take_snapshot(expected), query);
    right.utime = answered.utime;
    right.session = answered.session;
    EXPECT_TRUE(answered == right) << "after slice " << slice.id;
  }
}

TEST_F(QueryOnTheBus, SaysWhichMapsThereAreAndAsksTheOneThatIsNamed) {
  const auto office = named(testing::RoomRow(1, 0.08).cut(1.0, 5), "office");
  const auto hall = named(testing::RoomRow(2, 0.08).cut(1.0, 6), "hall");
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.exit_on_final = false;
  Listener listener(config);
  QueryClient client(kPrivateBusUrl);
  EXPECT_EQ(client.ask(largest(1), Seconds(60)).problem, "no map is kept yet");
  StreamPublisher first(listener.bus(), channels::kCloudSlice, 5, {});
  StreamPublisher second(listener.bus(), channels::kCloudSlice, 6, {});
  for (const CloudSlice& slice : office) first.publish(slice);
  for (const CloudSlice& slice : hall) second.publish(slice);
  ASSERT_TRUE(listener.hears(
      [&] { return listener.status->maps == 2 && listener.status->lag_slices == 0; }));
  EXPECT_THAT(client.ask(largest(1), Seconds(60)).problem,
              AllOf(HasSubstr("'office' of session 5"), HasSubstr("'hall' of session 6")));
  SegmentQuery query = largest(1);
  query.map_name = "office";
  EXPECT_EQ(client.ask(query, Seconds(60)).map_session, 5);
  query = largest(1);
  query.map_session = 6;
  EXPECT_EQ(client.ask(query, Seconds(60)).map_name, "hall");
}

TEST_F(QueryOnTheBus, IsNotKeptFromAnsweringByWhoAsksTooMuchOrSendsNonsense) {
  const auto slices = testing::RoomRow(1, 0.08).cut(1.0);
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.exit_on_final = false;
  Listener listener(config);
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  ASSERT_TRUE(listener.hears([&] { return listener.last && listener.last->is_final; }));
  // More than wait at a time, of clients that are gone; then bytes that are no query.
  for (std::int64_t other = 1; other <= 100; ++other) {
    SegmentQuery query = largest(1);
    query.client = other;
    listener.bus().publish(channels::kSegmentQuery, query);
  }
  SegmentQuery valid;
  valid.client = 1;
  const Bytes query = encode(valid);
  for (std::size_t size = 0; size < query.size(); size += 7) {
    listener.bus().publish(channels::kSegmentQuery, ByteView(query).first(size));
  }
  QueryClient client(kPrivateBusUrl);
  EXPECT_EQ(client.ask(largest(2), Seconds(60)).segments.size(), 2U);
  const auto num_bad = static_cast<std::int64_t>((query.size() + 6) / 7);
  EXPECT_TRUE(listener.hears([&] { return listener.status->messages_bad == num_bad; }))
      << listener.status->messages_bad;
}

TEST_F(QueryOnTheBus, ProgramTellsOfSilence) {
  const auto alone = run_query("--timeout 0.7");
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_THAT(alone.output, AllOf(HasSubstr("nobody answered within 0.7 s"), HasSubstr("2 times"),
                                  HasSubstr("is kintsugi-segmenter running?")));
  EXPECT_THAT(run_query("--pixel 320 240 --timeout 0.5").output,
              HasSubstr("no mapper is heard there"));
  EXPECT_THAT(run_query("--map " + (folder_ / "none.kseg").string()).output,
              HasSubstr("none.kseg"));
  EXPECT_NE(run_query("--at 1 2").exit_code, 0);
  EXPECT_NE(run_query("--at 1 2 3 --id 5").exit_code, 0);
  EXPECT_NE(run_query("--at 1 2 nan --map x").exit_code, 0);
}

TEST_F(QueryOnTheBus, ProgramGivesTheSameOverTheBusAndOfTheSavedMap) {
  const auto slices = testing::RoomRow(1, 0.04).cut(0.5);
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.exit_on_final = false;
  config.segmentation.files.save_file = folder_ / "map.kseg";
  Listener listener(config);
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  ASSERT_TRUE(listener.hears([&] { return listener.last && listener.last->is_final; }));
  ASSERT_TRUE(listener.hears([&] { return std::filesystem::exists(folder_ / "map.kseg"); }));
  // A camera above the table that looks down, on the bus and by hand.
  CameraPose pose;
  pose.session = slices[0].session;
  pose.state = TrackingState::kTracking;
  pose.X_WC.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).matrix();
  pose.X_WC.translation() << 2.1, 1.4, 2.0;
  std::atomic<bool> stopping = false;
  std::thread camera([&] {
    Bus bus(kPrivateBusUrl);
    while (!stopping) {
      bus.publish(channels::kCameraPose, pose);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  for (const std::string what :
       {"--largest 3", "--planar --json", "--at 1 0.5 0", "--id 1,2,3",
        "--box 0 0 0 1 1 1 --json --largest 0", "--changed-since 1003 --largest 2"}) {
    const auto of_bus = run_query(what + " --timeout 60");
    EXPECT_EQ(of_bus.exit_code, 0);
    EXPECT_EQ(of_bus.output, run_query(what + " --map " + (folder_ / "map.kseg").string()).output);
  }
  const auto seen = run_query("--pixel 319.5 239.5 --json --timeout 60");
  stopping = true;
  camera.join();
  EXPECT_EQ(seen.output, run_query("--pixel 319.5 239.5 --json --pose 2.1 1.4 2 1 0 0 0 --map " +
                                   (folder_ / "map.kseg").string())
                             .output);
  const auto map = load_map(folder_ / "map.kseg");
  EXPECT_THAT(seen.output, HasSubstr("\"hit\": ["));
  EXPECT_THAT(seen.output, HasSubstr("\"points\": " + std::to_string(map->cloud().num_live())));
}

}  // namespace
}  // namespace kintsugi::segmenter
