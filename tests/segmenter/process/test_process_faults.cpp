// The process on a private bus, when things go wrong.

#include <algorithm>
#include <csignal>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "lcmtypes/bus/bus_thread.hpp"
#include "segmenter/io/saved_map.hpp"
#include "tests/segmenter/process/listener.hpp"
#include "tests/segmenter/process/mapper_imitation.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/small_disk.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::kPrivateBusUrl;
using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::Labels;
using testing::labels_in;
using testing::Listener;
using testing::MapperImitation;
using testing::on_the_bus;
using testing::wavy_session;

std::vector<CloudSlice> named(std::vector<CloudSlice> slices, const std::string& name) {
  for (CloudSlice& slice : slices) {
    slice.map_name = name;
  }
  return slices;
}

/// What a segmenter makes of these slices when nothing goes wrong.
Labels labels_without_fault(const std::vector<CloudSlice>& slices, const std::string& mode) {
  SegmentMapConfig config;
  config.mode = mode;
  SegmentMap map(config, 1, slices.front());
  for (const CloudSlice& slice : slices) {
    map.add({&slice, 1});
  }
  return testing::labels_of(map);
}

class ProcessFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }

  TemporaryFolder folder_;
};

TEST_F(ProcessFaults, LateChunksOfAnOldSessionGoIntoItsOwnMap) {
  const auto older = wavy_session(5, 300, 5, 1);
  const auto newer = wavy_session(5, 300, 6, 2);
  Listener listener(on_the_bus(folder_, "exact"));
  // Of the older session chunks of several slices, its last ones too, come after the newer began.
  MapperImitation first(listener.bus(), 5, [](std::int64_t i) { return i % 13 == 9 || i > 20; });
  first.publish(older);
  EXPECT_TRUE(listener.hears([&] { return listener.status->chunks_missing > 0; }));
  MapperImitation second(listener.bus(), 6);
  second.publish({newer.begin(), newer.begin() + 3});
  EXPECT_TRUE(listener.hears([&] { return listener.status->maps == 2; }));
  first.answer(listener.bus());
  EXPECT_TRUE(listener.hears([&] { return listener.status->maps == 1; }));
  second.publish({newer.begin() + 3, newer.end()});
  EXPECT_EQ(listener.hear_the_end(), 0);

  EXPECT_EQ(labels_in(folder_ / "segments_5.ply"), labels_without_fault(older, "exact"));
  EXPECT_EQ(labels_in(folder_ / "segments.ply"), labels_without_fault(newer, "exact"));
  EXPECT_EQ(listener.mirrors[5].labels(), labels_without_fault(older, "exact"));
  EXPECT_EQ(listener.mirrors[6].labels(), labels_without_fault(newer, "exact"));
  EXPECT_EQ(listener.status->map_session, 6);
  EXPECT_EQ(listener.status->slices_missing, 0);
}

TEST_F(ProcessFaults, MapsOfTwoMappersAreKeptApartByName) {
  const auto office = named(wavy_session(6, 300, 5, 1), "office");
  const auto kitchen = named(wavy_session(6, 300, 6, 2), "kit/chen");
  Listener listener(on_the_bus(folder_, "exact"));
  MapperImitation first(listener.bus(), 5);
  MapperImitation second(listener.bus(), 6);
  for (std::size_t i = 0; i < office.size(); ++i) {
    first.publish(office[i]);
    second.publish(kitchen[i]);
  }
  EXPECT_EQ(listener.hear_the_end(), 0);
  EXPECT_EQ(listener.status->maps, 2);
  EXPECT_EQ(labels_in(folder_ / "segments_office.ply"), labels_without_fault(office, "exact"));
  EXPECT_EQ(labels_in(folder_ / "segments_kit%2Fchen.ply"), labels_without_fault(kitchen, "exact"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "segments.ply"));
}

TEST_F(ProcessFaults, ABoundedQueueTakesEverythingInTheEndAlsoWhenTheFirstSliceCameLast) {
  const auto slices = wavy_session(20, 1000);
  SegmenterProcess::Config config = on_the_bus(folder_, "batch");  // all of the map for each slice
  config.max_queue_bytes = 100'000;                                // three slices
  Listener listener(config);
  const std::int64_t num_first = num_chunks(slices.front(), 2000);
  MapperImitation mapper(listener.bus(), 5,
                         [=](std::int64_t i) { return i < num_first || i % 11 == 0; });
  mapper.publish(slices);
  // Nothing can be segmented, and yet no more is taken than there is room for.
  EXPECT_TRUE(listener.hears([&] { return listener.status->chunks_refused > 0; }));
  EXPECT_EQ(listener.status->slices_segmented, 0);
  mapper.answer(listener.bus());
  EXPECT_EQ(listener.hear_the_end(), 0);
  EXPECT_EQ(listener.status->slices_segmented, 20);
  const Labels expected = labels_without_fault(slices, "batch");
  EXPECT_EQ(labels_in(folder_ / "segments.ply"), expected);
  EXPECT_EQ(listener.mirror().labels(), expected);
  // Slices, and as much of incomplete ones; of either one may be begun when there is hardly room;
  // and of what is next 256 chunks of 2 kB, when nothing else is in the way.
  EXPECT_LE(listener.max_queue_bytes, 2 * (100'000 + 33'000) + 256 * 2000);
}

TEST_F(ProcessFaults, AListenerThatComesLateHasWhatOneHasThatWasThereFromTheStart) {
  const auto slices = wavy_session(8, 400);
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.updates.min_store_bytes = 1;  // nothing is left of what was published before
  config.exit_on_final = false;
  Listener listener(config);
  MapperImitation mapper(listener.bus(), 5);
  mapper.publish({slices.begin(), slices.begin() + 5});
  EXPECT_TRUE(listener.hears([&] { return listener.status->slices_segmented == 5; }));

  Bus bus(kPrivateBusUrl);
  std::map<std::int64_t, SegmentUpdate> updates;
  StreamSubscriber<SegmentUpdate> late(channels::kSegmentUpdate, [&](SegmentUpdate update) {
    const std::int64_t sequence = update.sequence;
    updates.emplace(sequence, std::move(update));
  });
  late.subscribe(bus);
  PatientClock clock;
  const auto hears = [&](std::int32_t num_slices) {
    return listener.hears([&] {
      while (bus.handle(std::chrono::milliseconds(0))) {
      }
      late.ask(bus, clock.now_s());
      return !updates.empty() && updates.rbegin()->second.num_slices == num_slices &&
             late.counts().chunks_missing == 0;
    });
  };
  EXPECT_TRUE(hears(5));
  EXPECT_EQ(updates.size(), 5U);  // bounded by the map
  mapper.publish({slices.begin() + 5, slices.end()});
  EXPECT_TRUE(hears(8));
  EXPECT_TRUE(listener.hears([&] { return listener.status->finished; }));
  testing::LabelMirror mirror;
  for (const auto& [sequence, update] : updates) {
    mirror.apply(update);
  }
  EXPECT_EQ(mirror.labels(), listener.mirror().labels());
  EXPECT_EQ(mirror.labels(), labels_without_fault(slices, "exact"));
  EXPECT_EQ(mirror.statistics(), listener.mirror().statistics());
  EXPECT_GE(listener.status->states_sent, 1);
  EXPECT_LE(listener.status->states_sent, 2);
  EXPECT_GT(listener.status->state_bytes, 5 * 400 * 4);
}

// A segmenter that is started again by whoever killed it.
class RestartedSegmenter {
 public:
  explicit RestartedSegmenter(std::vector<std::string> arguments)
      : arguments_(std::move(arguments)) {
    start();
  }
  ~RestartedSegmenter() {
    if (pid_ > 0) {
      kill();
    }
  }
  void kill() {
    ::kill(pid_, SIGKILL);
    wait();
  }
  void start() {
    const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    const std::string program = here.parent_path() / "bin" / "kintsugi-segmenter";
    std::vector<char*> arguments{const_cast<char*>(program.c_str())};  // execv() changes nothing
    for (const std::string& argument : arguments_) {
      arguments.push_back(const_cast<char*>(argument.c_str()));
    }
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      execv(program.c_str(), arguments.data());
      _exit(127);
    }
  }
  int wait() {
    int status = 0;
    waitpid(std::exchange(pid_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  bool has_ended() {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == pid_;
  }

 private:
  std::vector<std::string> arguments_;
  pid_t pid_ = 0;
};

TEST_F(ProcessFaults, KilledAtAnyMomentAndRestartedEndsWithTheSameIds) {
  const auto slices = wavy_session(30, 300);
  for (const std::string mode : {"exact", "voting"}) {
    const Labels expected = labels_without_fault(slices, mode);
    for (const unsigned seed : {1U, 2U}) {
      const std::string out = folder_ / (mode + std::to_string(seed));
      std::filesystem::create_directory(out);
      Bus bus(kPrivateBusUrl);
      MapperImitation mapper(bus, 5);
      mapper.answer(bus);
      const BusThread answering(bus);
      RestartedSegmenter segmenter({"--lcm-url", kPrivateBusUrl, "--mode", mode, "--preset",
                                    "paper", "--out", out, "--save", out + "/map.kseg",
                                    "--save-every", "2", "--resume-if-saved", "--exit-on-final",
                                    "--linger", "0"});
      std::mt19937 random(seed);
      std::set<std::size_t> kills;
      while (kills.size() < 4) {
        kills.insert(random() % slices.size());
      }
      for (std::size_t i = 0; i < slices.size(); ++i) {
        mapper.publish(slices[i]);
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 60));
        if (kills.contains(i)) {
          segmenter.kill();
          segmenter.start();
        }
      }
      EXPECT_EQ(segmenter.wait(), 0);
      EXPECT_EQ(labels_in(out + "/segments.ply"), expected) << mode << " " << seed;
    }
  }
}

TEST_F(ProcessFaults, GoingOnAsksOnlyForWhatIsNotInTheSavedMap) {
  const auto slices = wavy_session(20, 300);
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.segmentation.files.save_file = folder_ / "map.kseg";
  config.segmentation.maps.each_map.save_every = 1;
  config.exit_on_final = false;
  {
    Listener listener(config);
    MapperImitation mapper(listener.bus(), 5);
    mapper.publish({slices.begin(), slices.end() - 1});
    EXPECT_TRUE(listener.hears([&] { return listener.status->slices_segmented == 19; }));
  }
  rearm_stop_signals();
  const SegmentMapState saved = read_map_state(config.segmentation.files.save_file);
  ASSERT_EQ(saved.chunks.size(), 1U);
  EXPECT_EQ(saved.chunks[0].first, 0);
  config.segmentation.resume_file = config.segmentation.files.save_file;
  config.exit_on_final = true;
  Listener listener(config);
  std::int64_t first_asked = std::numeric_limits<std::int64_t>::max();
  subscribe<ResendRequest>(listener.bus(), channels::kResendRequest,
                           [&](const ResendRequest& request) {
                             if (request.channel != channels::kCloudSlice) return;
                             for (const SequenceRange& range : request.ranges) {
                               first_asked = std::min(first_asked, range.first);
                             }
                           });
  MapperImitation mapper(listener.bus(), 5, [&](std::int64_t) { return true; });
  mapper.publish(slices);  // all of it is lost, and must be asked for
  mapper.answer(listener.bus());
  EXPECT_EQ(listener.hear_the_end(), 0);
  EXPECT_EQ(first_asked, saved.chunks[0].last + 1);
  EXPECT_EQ(labels_in(folder_ / "segments.ply"), labels_without_fault(slices, "exact"));
}

TEST_F(ProcessFaults, ASavedMapOfAnotherSessionIsKeptAsideAndTheNewOneBegins) {
  const auto older = wavy_session(4, 300, 5, 1);
  const auto newer = wavy_session(4, 300, 6, 2);
  SegmentMap saved({}, 1, older[0]);
  saved.add({older.data(), 3});
  write_map_state(saved.state(), folder_ / "map.kseg");
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.segmentation.files.save_file = config.segmentation.resume_file = folder_ / "map.kseg";
  Listener listener(config);
  MapperImitation mapper(listener.bus(), 6);
  mapper.publish(newer);
  EXPECT_EQ(listener.hear_the_end(), 0);
  EXPECT_EQ(labels_in(folder_ / "segments_5.ply"), testing::labels_of(saved));
  EXPECT_EQ(labels_in(folder_ / "segments.ply"), labels_without_fault(newer, "exact"));
  EXPECT_EQ(read_map_state(config.segmentation.files.save_file).map_session, 6);
}

class FullDisk : public ProcessFaults {
 protected:
  void SetUp() override {
    ProcessFaults::SetUp();
    if (IsSkipped()) return;
    if (const auto why_not = disk_.mount("128k")) GTEST_SKIP() << *why_not;
  }

  kintsugi::testing::SmallDisk disk_{folder_ / "disk"};
};

TEST_F(FullDisk, TheOldMapStaysAndTheNewIsWrittenWhenThereIsSpace) {
  const auto slices = wavy_session(20, 400);  // 36 bytes a point: three slices fit beside the old
  SegmenterProcess::Config config = on_the_bus(folder_, "exact");
  config.segmentation.files.save_file = disk_.folder() / "map.kseg";
  config.segmentation.maps.each_map.save_every = 1;
  config.segmentation.rewrite_period = std::chrono::milliseconds(200);
  config.exit_on_final = false;
  Listener listener(config);
  MapperImitation mapper(listener.bus(), 5);
  mapper.publish(slices[0]);
  EXPECT_TRUE(
      listener.hears([&] { return std::filesystem::exists(config.segmentation.files.save_file); }));
  mapper.publish({slices.begin() + 1, slices.end() - 1});
  EXPECT_TRUE(listener.hears([&] { return !listener.status->problem.empty(); }));
  EXPECT_THAT(listener.status->problem, HasSubstr("No space left"));
  EXPECT_TRUE(listener.hears([&] { return listener.status->slices_segmented == 19; }));
  const std::size_t num_saved = read_map_state(config.segmentation.files.save_file).slices.size();
  EXPECT_LT(num_saved, 19U);  // the old file, whole
  // With the views beside it, and no other, but while it tries.
  EXPECT_TRUE(listener.hears(
      [&] { return std::distance(std::filesystem::directory_iterator(disk_.folder()), {}) == 2; }));

  ASSERT_TRUE(disk_.resize("16m"));
  // What was being written may lack the newest slice; it comes by itself.
  EXPECT_TRUE(listener.hears([&] {
    return listener.status->problem.empty() &&
           read_map_state(config.segmentation.files.save_file).slices.size() == 19;
  }));
  mapper.publish(slices.back());
  EXPECT_TRUE(listener.hears([&] { return listener.status->finished; }));
  request_stop();
  EXPECT_EQ(listener.hear_the_end(), 0);  // all is well in the end
  rearm_stop_signals();
  EXPECT_EQ(testing::labels_of(*load_map(config.segmentation.files.save_file)),
            labels_without_fault(slices, "exact"));
}

}  // namespace
}  // namespace kintsugi::segmenter
