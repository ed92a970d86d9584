// The whole process: from a log, and over a real bus in a network namespace of the test's own.

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/process/process_status.hpp"
#include "segmenter/process/segmenter_process.hpp"
#include "tests/segmenter/evaluation/session/log_of_slices.hpp"
#include "tests/segmenter/evaluation/session/log_of_views.hpp"
#include "tests/segmenter/process/listener.hpp"
#include "tests/segmenter/process/room_session.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/segmenter/tools/program.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::labels_in;
using testing::Listener;
using ::testing::Not;
using testing::on_the_bus;
using testing::wavy_session;
using testing::write_log;

testing::LogMessages messages_of(const std::vector<CloudSlice>& slices) {
  testing::LogMessages messages;
  testing::append_slices(slices, messages);
  return messages;
}

TEST(SegmenterStreams, MapIsTheSameHoweverTheChunksArrive) {
  const auto slices = wavy_session(4, 200);
  auto messages = messages_of(slices);
  std::mt19937 random(5);
  const auto labels_after = [&] {
    std::vector<CloudSlice> received;
    StreamSubscriber<CloudSlice> subscriber(
        channels::kCloudSlice, [&](CloudSlice slice) { received.push_back(std::move(slice)); });
    for (const auto& [channel, message] : messages) {
      subscriber.handle(channel, message);
    }
    SegmentMapConfig config;
    config.mode = "voting";
    SessionMap map({}, std::make_unique<SegmentMap>(config, 1, received.front()));
    for (CloudSlice& slice : received) {
      EXPECT_FALSE(map.offer(std::move(slice), {}));
    }
    while (map.step({}, Outlook::kEnded).has_progressed) {
    }
    EXPECT_TRUE(map.counts().complete);
    return testing::labels_of(map.segment_map());
  };
  const auto expected = labels_after();
  for (int round = 0; round < 5; ++round) {
    std::shuffle(messages.begin(), messages.end(), random);
    EXPECT_EQ(labels_after(), expected);
    messages.push_back(messages[static_cast<std::size_t>(round)]);  // a duplicate
  }
}

TEST(SegmenterStatus, TellsWhatIsMissingAndWhatWasDropped) {
  SessionMaps::Counts maps;
  maps.maps = 2;
  maps.missing = 3;
  maps.dropped = 2;
  maps.lag = 5;
  StreamCounts slices;
  slices.chunks_missing = 7;
  slices.messages_bad = 1;
  UpdatePublisher::Counts updates;
  updates.stream.requests_bad = 4;
  updates.states = 9;
  const kintsugi::SegmenterStatus status = make_status(maps, slices, updates);
  EXPECT_EQ(status.maps, 2);
  EXPECT_EQ(status.slices_missing, 3);
  EXPECT_EQ(status.lag_slices, 5);
  EXPECT_EQ(status.chunks_missing, 7);
  EXPECT_EQ(status.messages_bad, 7);
  EXPECT_EQ(status.states_sent, 9);
}

class SegmenterProgram : public ::testing::Test {
 protected:
  testing::ProgramResult run(const std::string& arguments) {
    return testing::run_program("kintsugi-segmenter", arguments, folder_ / "log.txt");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(SegmenterProgram, SegmentsALogAndWritesTheMap) {
  const auto slices = wavy_session(5, 200);
  write_log(path("slices.lcm"), messages_of(slices));
  for (const std::string mode : {"batch", "voting"}) {
    const auto result =
        run("--log " + path("slices.lcm") + " --mode " + mode + " --out " + path("out"));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const PlyCloud cloud = read_ply(path("out") + "/segments.ply");
    EXPECT_EQ(cloud.points_W.size(), 1000U);

    SegmentMapConfig config;
    config.mode = mode;
    config.engine = preset("objects");
    SegmentMap map(config, 1, slices[0]);
    for (const CloudSlice& slice : slices) {
      map.add({&slice, 1});
    }
    testing::Labels labels;
    for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
      labels[cloud.slice_ids[i]].push_back(cloud.segment_ids[i]);
    }
    EXPECT_EQ(labels, testing::labels_of(map));  // the ids too: they do not depend on timing
    EXPECT_TRUE(std::filesystem::exists(path("out") + "/segments.json"));
  }
}

TEST_F(SegmenterProgram, HasTheSameMapWithLessMemoryThanItNeeds) {
  const TemporaryFolder disk(kintsugi::testing::kOnDisk);
  write_log(path("slices.lcm"), messages_of(wavy_session(8, 400)));
  const std::string log = "--log " + path("slices.lcm") + " --out ";
  EXPECT_EQ(run(log + path("all")).exit_code, 0);
  const auto result =
      run(log + path("less") + " --max-memory 1 --swap-folder " + disk.path().string());
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("parts of the map that are not used for long go to a file"));
  const PlyCloud all = read_ply(path("all") + "/segments.ply");
  const PlyCloud less = read_ply(path("less") + "/segments.ply");
  EXPECT_EQ(less.segment_ids, all.segment_ids);
  EXPECT_EQ(less.points_W, all.points_W);
}

// The timeout for what nobody sends is far longer than a test may take.
TEST_F(SegmenterProgram, HasTheSameMapOfALogWithAQueueThatHoldsNoBatch) {
  auto slices = wavy_session(12, 300);
  for (std::size_t i = 0; i + 1 < slices.size(); ++i) {
    slices[i].kind = SliceKind::kPatch;
    slices[i].ends_batch = i % 4 == 3;
  }
  slices.back().revision_sum = 0;
  auto messages = messages_of(slices);
  std::swap(messages[1], messages[6]);  // chunks out of order
  write_log(path("patches.lcm"), messages);
  const std::string log = "--log " + path("patches.lcm") + " --gap-timeout 10000 --out ";
  EXPECT_EQ(run(log + path("all")).exit_code, 0);
  const auto result = run(log + path("little") + " --max-queue 0.000001");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const PlyCloud all = read_ply(path("all") + "/segments.ply");
  const PlyCloud little = read_ply(path("little") + "/segments.ply");
  EXPECT_EQ(all.points_W.size(), 3600U);
  EXPECT_EQ(little.points_W, all.points_W);
  EXPECT_EQ(little.segment_ids, all.segment_ids);
}

TEST_F(SegmenterProgram, RefusesALimitOfMemoryThatItCannotKeep) {
  write_log(path("slices.lcm"), messages_of(wavy_session(2, 100)));
  const std::string log = "--log " + path("slices.lcm") + " --out " + path("out");
  const auto voting = run(log + " --mode voting --max-memory 100");
  EXPECT_NE(voting.exit_code, 0);
  EXPECT_THAT(voting.output, HasSubstr("--max-memory needs mode exact"));
  const auto nowhere = run(log + " --max-memory 100 --swap-folder " + path("nowhere"));
  EXPECT_NE(nowhere.exit_code, 0);
  EXPECT_THAT(nowhere.output, HasSubstr(path("nowhere")));
  EXPECT_NE(run("--check --max-memory 100 --swap-folder " + path("nowhere")).exit_code, 0);
  EXPECT_NE(run(log + " --swap-folder " + path("")).exit_code, 0);
}

TEST_F(SegmenterProgram, RefusesOptionsThatDoNothing) {
  const auto unsaved = run("--check --save-every 5");
  EXPECT_NE(unsaved.exit_code, 0);
  EXPECT_THAT(unsaved.output, HasSubstr("--save-every needs --save FILE"));
  EXPECT_EQ(run("--check --save-every 5 --save " + path("a.map")).exit_code, 0);
  EXPECT_THAT(run("--check --linger nan").output, HasSubstr("'nan' is no finite number"));
}

TEST_F(SegmenterProgram, ChecksTheFilesAndTheBusThatARunOpens) {
  write_log(path("slices.lcm"), messages_of(wavy_session(2, 100)));
  EXPECT_EQ(run("--check --log " + path("slices.lcm")).exit_code, 0);
  const auto expect_error = [&](const std::string& arguments, const std::string& reason) {
    const auto result = run("--check " + arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    EXPECT_THAT(result.output, HasSubstr(reason));
  };
  expect_error("--log " + path("nowhere.lcm"), path("nowhere.lcm"));
  expect_error("--resume " + path("nowhere.map"), path("nowhere.map"));
  expect_error("--lcm-url foo://", "cannot open the bus foo://");
}

TEST_F(SegmenterProgram, WritesTheMapOfEachSessionInALog) {
  auto messages = messages_of(wavy_session(2, 100, 5));
  const auto more = messages_of(wavy_session(2, 150, 6));
  messages.insert(messages.end(), more.begin(), more.end());
  write_log(path("slices.lcm"), messages);
  const auto result = run("--log " + path("slices.lcm") + " --out " + path("out"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(read_ply(path("out") + "/segments_5.ply").points_W.size(), 200U);
  EXPECT_EQ(read_ply(path("out") + "/segments.ply").points_W.size(), 300U);
}

TEST_F(SegmenterProgram, ReportsGapsAndDamageOfALogAndKeepsWhatItCouldRead) {
  auto messages = messages_of(wavy_session(4, 200));
  messages.erase(messages.begin() + 5);  // a chunk of slice 1
  write_log(path("gap.lcm"), messages);
  const auto gap = run("--log " + path("gap.lcm") + " --out " + path("gap"));
  EXPECT_EQ(gap.exit_code, 1);
  EXPECT_THAT(gap.output, AllOf(HasSubstr("1 slices are missing from the map"),
                                HasSubstr("slices 1 to 1 of session 5 are missing")));
  EXPECT_EQ(read_ply(path("gap") + "/segments.ply").points_W.size(), 600U);

  write_log(path("cut.lcm"), messages_of(wavy_session(4, 200)));
  std::filesystem::resize_file(path("cut.lcm"), std::filesystem::file_size(path("cut.lcm")) - 900);
  const auto cut = run("--log " + path("cut.lcm") + " --out " + path("cut"));
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_THAT(cut.output, AllOf(HasSubstr("cut.lcm"), HasSubstr("is damaged at byte"),
                                HasSubstr("lacks its last")));
  EXPECT_EQ(read_ply(path("cut") + "/segments.ply").points_W.size(), 600U);

  const auto absent = run("--log " + path("absent.lcm") + " --out " + path("absent"));
  EXPECT_EQ(absent.exit_code, 1);
  EXPECT_THAT(absent.output, HasSubstr("absent.lcm"));

  write_log(path("other.lcm"), {{"SOMETHING_ELSE", Bytes{1, 2, 3}}});
  const auto other = run("--log " + path("other.lcm") + " --out " + path("other"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.output, HasSubstr("holds no slice"));
}

TEST_F(SegmenterProgram, RefusesAFileThatIsNoLogAndWritesNothing) {
  std::ofstream(path("foreign.lcm")) << std::string(5000, 'x');
  std::ofstream(path("empty.lcm")).flush();
  std::filesystem::create_directory(path("folder.lcm"));
  const auto refusal = [&](const std::string& name) {
    const auto result = run("--log " + path(name) + " --out " + path("out"));
    EXPECT_EQ(result.exit_code, 1) << name;
    EXPECT_FALSE(std::filesystem::exists(path("out"))) << name;
    return result.output;
  };
  EXPECT_THAT(refusal("foreign.lcm"), HasSubstr("foreign.lcm' is no LCM log"));
  EXPECT_THAT(refusal("empty.lcm"), HasSubstr("empty.lcm' is empty"));
  EXPECT_THAT(refusal("folder.lcm"), HasSubstr("folder.lcm' is a folder"));
}

TEST_F(SegmenterProgram, KeepsWhatItReadBeforeForeignBytesInALog) {
  write_log(path("spoilt.lcm"), messages_of(wavy_session(4, 200)));
  std::ofstream(path("spoilt.lcm"), std::ios::binary | std::ios::app) << std::string(200, 'x');
  const auto result = run("--log " + path("spoilt.lcm") + " --out " + path("out"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("expected the sync word"));
  EXPECT_EQ(read_ply(path("out") + "/segments.ply").points_W.size(), 800U);
}

TEST_F(SegmenterProgram, ReportsAFolderItCannotWriteTo) {
  write_log(path("slices.lcm"), messages_of(wavy_session(2, 100)));
  std::ofstream(path("taken")) << "a file";
  const auto result = run("--log " + path("slices.lcm") + " --out " + path("taken"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("the map is not written"), HasSubstr("taken")));
}

TEST_F(SegmenterProgram, AuditsModeExactAndNoOther) {
  write_log(path("slices.lcm"), messages_of(wavy_session(4, 150)));
  const std::string log = "--log " + path("slices.lcm") + " --out " + path("out") + " --audit";
  const auto result = run(log);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const auto refused = run(log + " --mode voting");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("audit is on, and mode is 'voting'"));
}

TEST_F(SegmenterProgram, RefusesParametersOutOfRange) {
  EXPECT_THAT(run("--mode none").output, HasSubstr("mode is 'none'"));
  EXPECT_EQ(run("--threshold -1").exit_code, 1);
  EXPECT_NE(run("--gap-timeout 0").exit_code, 0);
  EXPECT_NE(run("--config " + path("absent.toml")).exit_code, 0);
}

TEST_F(SegmenterProgram, ReadsTheConfigThatItPrints) {
  const auto printed = run("--threshold 0.002 --mode voting --neighbours flann --print-config");
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_THAT(printed.output, AllOf(HasSubstr("threshold=0.002"), HasSubstr("mode=\"voting\"")));
  std::ofstream(path("config.toml")) << printed.output;
  const auto again = run("--config " + path("config.toml") + " --print-config");
  EXPECT_EQ(again.output, printed.output);
}

TEST_F(SegmenterProgram, GoesOnWithTheMapThatWasSavedAfterAnySlice) {
  auto slices = wavy_session(6, 150);
  CloudSlice corrected = testing::moved(slices[1], testing::small_motion());
  slices.insert(slices.begin() + 4, corrected);
  write_log(path("all.lcm"), messages_of(slices));
  for (const std::string mode : {"exact", "batch", "voting"}) {
    // What `voting` would go on with is the segments after fragments have been joined.
    std::string options = " --mode " + mode + " --out " + path("out");
    options += mode == "voting" ? " --preset paper" : " --preset objects";
    EXPECT_EQ(run("--log " + path("all.lcm") + options).exit_code, 0);
    const auto expected = labels_in(path("out") + "/segments.ply");
    for (std::size_t count = 1; count <= slices.size(); ++count) {
      write_log(path("some.lcm"), messages_of({slices.begin(), slices.begin() + count}));
      const auto saved = run("--log " + path("some.lcm") + options + " --save " + path("map.kseg"));
      EXPECT_EQ(saved.exit_code, 0) << saved.output;
      const auto resumed = run("--log " + path("all.lcm") + options + " --resume " +
                               path("map.kseg") + " --save " + path("map.kseg"));
      EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
      EXPECT_THAT(resumed.output, HasSubstr("resumed " + path("map.kseg")));
      EXPECT_EQ(labels_in(path("out") + "/segments.ply"), expected) << mode << count;
    }
    const auto nothing_new = run("--log " + path("all.lcm") + options + " --resume " +
                                 path("map.kseg") + " --exit-on-final");
    EXPECT_EQ(nothing_new.exit_code, 0) << nothing_new.output;
  }
}

TEST_F(SegmenterProgram, RefusesToGoOnWithWhatIsNoMapOfItsOwn) {
  write_log(path("slices.lcm"), messages_of(wavy_session(3, 100)));
  const std::string log = "--log " + path("slices.lcm") + " --out " + path("out");
  ASSERT_EQ(run(log + " --save " + path("out") + "/new/map.kseg").exit_code, 0);
  std::filesystem::rename(path("out") + "/new/map.kseg", path("map.kseg"));
  std::filesystem::remove_all(path("out"));
  const auto refusal = [&](const std::string& arguments) {
    const auto result = run(log + " " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_FALSE(std::filesystem::exists(path("out"))) << arguments;
    return result.output;
  };
  EXPECT_THAT(refusal("--resume " + path("map.kseg") + " --threshold 0.002"),
              HasSubstr("was saved with --threshold 0.001, and here it is 0.002"));
  EXPECT_THAT(refusal("--resume " + path("map.kseg") + " --color-weight 0.01"),
              HasSubstr("was saved with --color-weight 0.003, and here it is 0.01"));
  EXPECT_THAT(refusal("--resume " + path("map.kseg") + " --min-points 0"),
              HasSubstr("was saved with --min-points 50, and here it is 0"));
  EXPECT_THAT(refusal("--resume " + path("map.kseg") + " --preset paper"),
              HasSubstr("was saved with --scale 0.002, and here it is 0.0005"));
  EXPECT_THAT(refusal("--resume " + path("map.kseg") + " --mode voting"),
              HasSubstr("was saved with --mode exact"));
  EXPECT_THAT(refusal("--resume " + path("absent.kseg")),
              AllOf(HasSubstr("absent.kseg"), Not(HasSubstr("holds no slice"))));
  EXPECT_THAT(refusal("--resume " + path("slices.lcm")), HasSubstr("is no saved segment map"));
  std::filesystem::resize_file(path("map.kseg"), std::filesystem::file_size(path("map.kseg")) - 1);
  EXPECT_THAT(refusal("--resume " + path("map.kseg")), HasSubstr("cut off or damaged"));
}

TEST_F(SegmenterProgram, SavesTheViewsOfTheCameraBesideTheMap) {
  const auto slices = wavy_session(3, 100);
  const auto write_session = [&](std::size_t num_slices, std::int64_t num_views) {
    testing::LogMessages messages =
        messages_of({slices.begin(), slices.begin() + static_cast<std::ptrdiff_t>(num_slices)});
    std::vector<CameraView> views;
    for (std::int64_t i = 0; i < num_views; ++i) {
      views.push_back(testing::view_at(static_cast<double>(i), 1000 + i));
    }
    testing::append_views(views, messages);
    write_log(path("slices.lcm"), messages);
  };
  const std::string map = path("map.kseg");
  const std::string views = map + ".views";
  const std::string log =
      "--log " + path("slices.lcm") + " --out " + path("out") + " --save " + map;
  write_session(2, 3);
  ASSERT_EQ(run(log).exit_code, 0);
  EXPECT_EQ(read_views_of(views, slices[0].session, "map").views.size(), 3U);
  write_session(3, 5);  // of which the first two slices and three views are known
  const auto resumed = run(log + " --resume " + map);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
  EXPECT_THAT(resumed.output, HasSubstr("resumed " + views + ": 3 views"));
  EXPECT_EQ(read_views(views).views.size(), 5U);
  std::filesystem::remove(views);
  const auto without = run(log + " --resume " + map);
  EXPECT_EQ(without.exit_code, 0) << without.output;
  EXPECT_THAT(without.output, HasSubstr("there is no " + views));
  ViewSet foreign;
  foreign.map_session = 77;
  write_views(foreign, views);
  const auto replaced = run(log + " --resume " + map);
  EXPECT_EQ(replaced.exit_code, 0) << replaced.output;
  EXPECT_THAT(replaced.output, HasSubstr("has the views of session 77"));
  std::ofstream(views) << "KVIEWS damaged";
  const auto damaged = run(log + " --resume " + map);
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_THAT(damaged.output, HasSubstr("'" + views + "'"));
}

class SegmenterOnTheBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

TEST_F(SegmenterOnTheBus, PublishesUpdatesAndStatusUntilTheFinalSlice) {
  const TemporaryFolder folder;
  const auto slices = wavy_session(6, 300);
  Listener listener(on_the_bus(folder, "voting"));
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  for (const CloudSlice& slice : slices) {
    publisher.publish(slice);
  }
  EXPECT_EQ(listener.hear_the_end(), 0);
  const auto& status = listener.status;
  EXPECT_EQ(status->slices_segmented, 6);
  EXPECT_EQ(status->lag_slices, 0);
  EXPECT_EQ(status->points, 1800);
  EXPECT_EQ(status->mode, "voting");
  EXPECT_EQ(status->segments, listener.mirror().num_segments());
  EXPECT_GT(status->memory_bytes, 0);
  EXPECT_EQ(labels_in(folder / "segments.ply"), listener.mirror().labels());
}

TEST_F(SegmenterOnTheBus, SavesTheViewsThatItHears) {
  const TemporaryFolder folder;
  const auto slices = wavy_session(2, 300);
  SegmenterProcess::Config config = on_the_bus(folder, "exact");
  config.segmentation.files.save_file = folder / "map.kseg";
  Listener listener(config);
  StreamPublisher views(listener.bus(), channels::kCameraView, slices[0].session, {});
  views.publish(testing::view_at(0.0, 900));
  views.publish(testing::view_at(1.0, 901));
  views.flush();
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  EXPECT_EQ(listener.hear_the_end(), 0);
  EXPECT_EQ(read_views_of(folder / "map.kseg.views", slices[0].session, "map").views.size(), 2U);
}

TEST_F(SegmenterOnTheBus, SegmentsEverySliceOfABurstHoweverSlowEngineAndFilesAre) {
  const TemporaryFolder folder;
  const auto slices = wavy_session(50, 300);
  SegmenterProcess::Config config = on_the_bus(folder, "batch");  // all of the map for each slice
  config.segmentation.maps.each_map.write_every = 1;
  Listener listener(config);
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  for (const CloudSlice& slice : slices) {
    publisher.publish(slice);
  }
  EXPECT_EQ(listener.hear_the_end(), 0);
  EXPECT_EQ(listener.status->slices_segmented, 50);
  EXPECT_EQ(listener.status->lag_slices, 0);
  EXPECT_EQ(listener.status->chunks_missing, 0);
  EXPECT_EQ(labels_in(folder / "segments.ply"), listener.mirror().labels());
}

TEST_F(SegmenterOnTheBus, FollowsCorrections) {
  const TemporaryFolder folder;
  const auto slices = testing::RoomRow(1, 0.05).cut(0.4);
  std::vector<CloudSlice> moved;
  for (std::size_t i = slices.size() / 3; i < 2 * slices.size() / 3; ++i) {
    moved.push_back(testing::moved(slices[i], testing::small_motion()));
  }
  const auto num_moved = std::ssize(moved);
  Listener listener(on_the_bus(folder, "exact"));
  StreamPublisher publisher(listener.bus(), channels::kCloudSlice, slices[0].session, {});
  const auto publish = [&](const std::vector<CloudSlice>& some) {
    for (const CloudSlice& slice : some) {
      publisher.publish(slice);
    }
  };
  publish({slices.begin(), slices.end() - 1});
  publish(moved);
  EXPECT_TRUE(listener.hears([&] { return listener.status->slices_corrected == num_moved; }));
  for (CloudSlice& slice : moved) {
    slice.points_W = slices[static_cast<std::size_t>(slice.id)].points_W;
    ++slice.revision;
  }
  publish(moved);
  EXPECT_TRUE(listener.hears([&] { return listener.status->slices_corrected == 2 * num_moved; }));
  publish({slices.back()});
  EXPECT_EQ(listener.hear_the_end(), 0);

  EXPECT_EQ(labels_in(folder / "segments.ply"), listener.mirror().labels());
  SegmentMapConfig config;
  config.mode = "batch";
  SegmentMap batch(config, 1, slices[0]);
  batch.add(slices);
  EXPECT_TRUE(testing::same_partition(listener.mirror().labels(), testing::labels_of(batch)));
}

}  // namespace
}  // namespace kintsugi::segmenter
