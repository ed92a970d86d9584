// Questions to a segmenter over a real bus, in a network namespace of the test's own.

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/process/query_responder.hpp"
#include "segmenter/query/answer.hpp"
#include "segmenter/tools/query/query_client.hpp"
#include "tests/segmenter/evaluation/session/log_of_views.hpp"
#include "tests/segmenter/process/listener.hpp"
#include "tests/segmenter/process/room_session.hpp"
#include "tests/segmenter/query/camera_view.hpp"
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
  /// The first that ends in another way than with `exit_code`: a view takes its time to arrive.
  testing::ProgramResult run_query_until_not(int exit_code, const std::string& arguments) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (true) {
      testing::ProgramResult result = run_query(arguments);
      if (result.exit_code != exit_code || std::chrono::steady_clock::now() > deadline) {
        return result;
      }
    }
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

TEST_F(QueryOnTheBus, TellsWhatTheCameraSaw) {
  const auto slices = testing::RoomRow(1, 0.08).cut(1.0);
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.exit_on_final = false;
  Listener listener(config);
  QueryClient client(kPrivateBusUrl);
  const auto ask = [&](std::int64_t since_us) {
    SegmentQuery query;
    query.place = QueryPlace::kViews;
    query.map_session = slices[0].session;
    query.changed_since = since_us;
    return client.ask(query, Seconds(60));
  };
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  publisher.publish(slices[0]);
  ASSERT_TRUE(listener.hears([&] { return listener.last.has_value(); }));
  const std::vector<std::uint8_t> none = ask(0).views;
  EXPECT_FALSE(none.empty());  // so that it is told from an answer without segments
  EXPECT_TRUE(views_of_bytes(none, "answer").views.empty());

  // More than one answer holds, from time 0 on, at which recordings begin; the segmenter has them
  // in hand before the slices that follow.
  constexpr auto kMaxViews = static_cast<std::int64_t>(QueryResponder::kMaxViews);
  constexpr std::int64_t kViews = kMaxViews + 50;
  StreamPublisher camera(listener.bus(), channels::kCameraView, slices[0].session, {});
  for (std::int64_t i = 0; i < kViews; ++i)
    camera.publish(testing::view_at(static_cast<double>(i), i));
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  std::vector<KeptView> views;
  ASSERT_TRUE(listener.hears([&] {
    views = views_of_bytes(ask(kMaxViews).views, "answer").views;
    return std::ssize(views) == 50;
  }));
  EXPECT_EQ(views.front().utime, kMaxViews);
  EXPECT_EQ(views.back().utime, kViews - 1);
  const SegmentAnswer first = ask(0);
  EXPECT_EQ(first.map_slices, 4);
  EXPECT_TRUE(first.segments.empty());
  const ViewSet oldest = views_of_bytes(first.views, "answer");
  EXPECT_EQ(oldest.map_session, slices[0].session);
  ASSERT_EQ(std::ssize(oldest.views), kMaxViews);
  EXPECT_EQ(oldest.views.front().utime, 0);
  EXPECT_EQ(oldest.views.front().X_WC.translation(), testing::view_at(0, 0).X_WC.translation());
  EXPECT_TRUE(views_of_bytes(ask(kViews).views, "answer").views.empty());
}

TEST_F(QueryOnTheBus, ProgramTellsOfSilence) {
  const auto alone = run_query("--timeout 0.7");
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_THAT(alone.output, AllOf(HasSubstr("nobody answered within 0.7 s"), HasSubstr("2 times"),
                                  HasSubstr("is kintsugi-segmenter running?")));
  EXPECT_THAT(run_query("--pixel 320 240 --map x").output, HasSubstr("needs --pose"));
  EXPECT_THAT(run_query("--map x --pose 0 0 1 0 0 0 1").output, HasSubstr("requires --pixel"));
  EXPECT_THAT(run_query("--pixel 320 240 --intrinsics 500 500 320 240 640 480").output,
              HasSubstr("--intrinsics requires --pose"));
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
  for (const std::string what :
       {"--largest 3", "--planar --json", "--at 1 0.5 0", "--id 1,2,3",
        "--box 0 0 0 1 1 1 --json --largest 0", "--changed-since 1003 --largest 2",
        "--pixel 319.5 239.5 --json --pose 2.1 1.4 2 1 0 0 0"}) {
    const auto of_bus = run_query(what + " --timeout 60");
    EXPECT_EQ(of_bus.exit_code, 0);
    EXPECT_EQ(of_bus.output, run_query(what + " --map " + (folder_ / "map.kseg").string()).output);
  }
}

/// Publishes what a camera sees ten times a second, as a mapper does.
class CameraOnTheBus {
 public:
  explicit CameraOnTheBus(const CameraView& view)
      : view_(view), stream_(bus_, channels::kCameraView, view.session, {}), thread_([this] {
          while (!stopping_) {
            publish();
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
          }
        }) {}
  ~CameraOnTheBus() {
    stopping_ = true;
    thread_.join();
  }
  /// From now on it sees this.
  void look_at(const CameraView& view) {
    const std::lock_guard lock(mutex_);
    view_ = view;
  }

 private:
  void publish() {
    const std::lock_guard lock(mutex_);
    ++utime_;
    view_.utime = utime_;
    stream_.publish(view_);
  }

  std::atomic<bool> stopping_ = false;
  Bus bus_{kPrivateBusUrl};
  std::mutex mutex_;  // guards the next two
  CameraView view_;
  std::int64_t utime_ = 0;
  StreamPublisher stream_;
  std::thread thread_;
};

TEST_F(QueryOnTheBus, PixelIsWhatTheCameraMeasuresOrWhyThereIsNoSegment) {
  const auto slices = testing::RoomRow(1, 0.04).cut(0.5);
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.exit_on_final = false;
  Listener listener(config);
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  ASSERT_TRUE(listener.hears([&] { return listener.last && listener.last->is_final; }));
  const std::string pixel = "--pixel 320 240 --timeout 60 ";
  const auto none = run_query(pixel);
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.output, HasSubstr("no view of the camera"));

  // 0.2 m above the table is a thing that is in no slice.
  const Pose X_WC = testing::looking_down(2.1, 1.4, 2.0);
  const CameraView thing = testing::view_of_wall(slices[0].session, X_WC, 1.1);
  CameraOnTheBus camera(thing);
  const auto hidden = run_query_until_not(none.exit_code, pixel);
  EXPECT_EQ(hidden.exit_code, 5);
  EXPECT_THAT(hidden.output, HasSubstr("1.10 m away, is in no segment yet"));
  EXPECT_THAT(run_query(pixel + "--json").output,
              AllOf(HasSubstr("\"hit\": null"), HasSubstr("\"surface_distance_m\": 1.1"),
                    HasSubstr("\"view_utime\": ")));
  EXPECT_THAT(run_query("--pixel 900 240 --timeout 60").output, HasSubstr("outside the image"));

  camera.look_at(testing::blind_view(slices[0].session, X_WC));
  const auto blind = run_query_until_not(hidden.exit_code, pixel);
  EXPECT_EQ(blind.exit_code, 4);
  EXPECT_THAT(blind.output, HasSubstr("measures nothing at this pixel"));

  camera.look_at(testing::view_of_wall(slices[0].session, X_WC, 1.3));
  const auto table = run_query_until_not(blind.exit_code, pixel + "--json");
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_THAT(table.output, HasSubstr("\"hit\": ["));
}

}  // namespace
}  // namespace kintsugi::segmenter
