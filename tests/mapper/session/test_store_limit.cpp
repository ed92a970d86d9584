// A log whose files are kept below a limit: what is left of it gives the same map as all of it.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/session/session_store.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::example_camera_pose;
using kintsugi::testing::example_correction;
using kintsugi::testing::example_mapper_status;
using kintsugi::testing::example_patch;
using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kSession = 42;  // of the examples
constexpr std::size_t kChunkBytes = 20'000;
constexpr std::int64_t kLimit = 4'000'000;
constexpr std::int32_t kNumPatches = 24;
constexpr std::int64_t kTrackedOnlyStep = 5;  // every fifth frame is only tracked

/// The map as a receiver has it who got these slices, in any order.
struct ReceivedMap {
  std::map<std::int32_t, CloudSlice> newest;  // by id
  PatchMotions motions;

  void take(const CloudSlice& slice) {
    motions.learn(slice);
    if (slice.superseded) return;
    const auto [known, is_new] = newest.try_emplace(slice.id, slice);
    if (!is_new && slice.revision > known->second.revision) known->second = slice;
  }
};

void expect_same_map(const ReceivedMap& found, const ReceivedMap& expected) {
  ASSERT_EQ(found.newest.size(), expected.newest.size()) << "every id counts";
  for (const auto& [id, slice] : expected.newest) {
    const CloudSlice& other = found.newest.at(id);
    EXPECT_EQ(other.revision, slice.revision) << id;
    EXPECT_EQ(other.points_W, slice.points_W) << id;
    if (slice.kind != SliceKind::kPatch) continue;
    EXPECT_EQ(found.motions.place_of(other), expected.motions.place_of(slice)) << id;
  }
}

/// A mapper that revises its patches, some of which move now and then, and what it has sent.
class Mapper {
 public:
  explicit Mapper(SessionStore& store)
      : store_(store), stream_(store.stream(channels::kCloudSlice, kSession)) {}

  ReceivedMap map;
  std::int64_t frames = 0;

  void step() {
    CameraPose pose = example_camera_pose();
    pose.utime = 1'000'000 + 33'333 * frames++;
    if (frames % kTrackedOnlyStep == 0) {
      store_.add(kTrackedOnlyChannel, encode_mapped_frames(kSession, {&pose.utime, 1}));
    }
    store_.add(channels::kCameraPose, encode(pose));
    const auto number = static_cast<std::int32_t>(random_() % 40);
    if (number == 0) {
      MapperStatus status = example_mapper_status();
      status.session = kSession;
      store_.add(channels::kMapperStatus, encode(status));
    } else if (number == 1) {
      send_correction();
    } else {
      send_patch(number == 2);
    }
  }

  void send(const CloudSlice& slice) {
    map.take(slice);
    const std::int32_t count = num_chunks(slice, kChunkBytes);
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int64_t sequence = stream_.next_sequence();
      stream_.add(sequence, encode_chunk(slice, sequence, i, kChunkBytes));
    }
  }

 private:
  /// Patches of small numbers are seen again more often; some only once.
  void send_patch(bool superseded) {
    const auto patch = static_cast<std::int32_t>(std::min(random_() % kNumPatches, random_() % 40));
    const auto [id, is_new] = id_of_.try_emplace(patch, next_id_);
    if (is_new) ++next_id_;
    CloudSlice slice = example_patch(300 + static_cast<int>(random_() % 900), id->second);
    slice.revision = is_new ? 0 : ++revision_of_[patch];
    slice.correction = correction_;
    if (superseded && !is_new) {
      slice.superseded = true;
      slice.points_W.clear();
    }
    send(slice);
    if (slice.superseded) send_patch_again(patch, id->second);
  }

  void send_patch_again(std::int32_t patch, std::int32_t id) {
    CloudSlice slice = example_patch(200, id);
    slice.revision = ++revision_of_[patch];
    slice.correction = correction_;
    send(slice);
  }

  void send_correction() {
    CloudSlice correction = example_correction(0, next_id_++);
    correction.correction = ++correction_;
    for (const auto& [patch, id] : id_of_) {
      Pose X_WP = Pose::Identity();
      X_WP.translation().x() = 0.25 * correction_;
      if (random_() % 3 != 0) correction.motions.push_back({id, X_WP});
    }
    std::ranges::sort(correction.motions, {}, &PatchMotion::id);
    correction.loops = example_correction(1).loops;
    send(correction);
  }

  SessionStore& store_;
  StoredStream& stream_;
  std::mt19937 random_{3};
  std::map<std::int32_t, std::int32_t> id_of_;
  std::map<std::int32_t, std::int32_t> revision_of_;
  std::int32_t next_id_ = 0;
  std::int32_t correction_ = 0;
};

bool wait_until(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

SessionStore::Config config_for(const fs::path& path, bool durable = false) {
  SessionStore::Config config;
  config.path = path;
  config.max_total_bytes = kLimit;
  config.durable = durable;
  config.sync_period = std::chrono::milliseconds(2);
  return config;
}

SessionStore::Config continued(SessionStore::Config config) {
  config.resume = true;
  return config;
}

/// The numbers of the files in the folder.
std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

/// Whether the log in this folder has removed the file with number 1.
bool is_rewritten(const fs::path& path) {
  return !fs::exists(path.parent_path() / "run.1.lcm") && fs::file_size(path) > 0;
}

std::int64_t bytes_of_files(const fs::path& folder) {
  std::int64_t bytes = 0;
  for (const auto& file : fs::directory_iterator(folder)) {
    std::error_code is_removed;  // meanwhile
    bytes += static_cast<std::int64_t>(file.file_size(is_removed));
  }
  return bytes;
}

/// Steps unless the log is to be rewritten, which is at half of the limit: a busy machine may leave
/// the thread that does it so little time that the mapper would outrun it. Returns whether it has.
bool step_if_there_is_room(Mapper& mapper, SessionStore& store) {
  store.retry();
  const bool is_room = store.report().size_bytes < kLimit / 16 * 9;
  if (is_room) mapper.step();
  return is_room;
}

/// Steps until the log has been rewritten `times` times, and its last file has something.
void step_until_rewritten(Mapper& mapper, SessionStore& store, const fs::path& path, int times) {
  for (int i = 0; i < times; ++i) {
    const std::int64_t size = store.report().size_bytes;
    std::int64_t largest = size;
    ASSERT_TRUE(wait_until([&] {
      step_if_there_is_room(mapper, store);
      const std::int64_t now = store.report().size_bytes;
      const bool has_shrunk = now + kLimit / 8 < largest;
      largest = std::max(now, largest);
      return has_shrunk && is_rewritten(path);
    }));
  }
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(wait_until([&] { return step_if_there_is_room(mapper, store); }));
  }
}

/// What a receiver who comes late gets of a log: every chunk that it has, and what is replaced,
/// which becomes more while the log is rewritten.
ReceivedMap received_late(StoredStream& stream) {
  ReceivedMap map;
  StreamSubscriber<CloudSlice> subscriber(channels::kCloudSlice,
                                          [&](const CloudSlice& slice) { map.take(slice); });
  for (std::int64_t i = 0; i < stream.next_sequence(); ++i) {
    if (const auto chunk = stream.find(i)) subscriber.handle(channels::kCloudSlice, *chunk);
  }
  ChunksReplaced replaced;
  replaced.session = kSession;
  replaced.channel = channels::kCloudSlice;
  for (const SequenceRange& range : stream.replaced(0, SIZE_MAX)) {
    replaced.ranges = {range};
    subscriber.handle(channels::kChunksReplaced, encode(replaced));
  }
  EXPECT_EQ(subscriber.counts().chunks_missing, 0) << "of " << stream.next_sequence();
  EXPECT_EQ(subscriber.counts().messages_bad, 0);
  EXPECT_EQ(subscriber.pending_bytes(), 0U);
  return map;
}

void expect_whole(SessionStore& store, const Mapper& mapper) {
  StoredStream& stream = store.stream(channels::kCloudSlice, kSession);
  EXPECT_EQ(stream.first_sequence(), 0) << "nothing is lost";
  expect_same_map(received_late(stream), mapper.map);
}

void expect_resumable(const fs::path& path, const Mapper& mapper) {
  SessionStore store(continued(config_for(path)));
  expect_whole(store, mapper);
  ASSERT_EQ(store.sessions().size(), 1U);
  EXPECT_EQ(store.sessions()[0].options, (MappingOptions{{"device", "a"}}));
  ASSERT_EQ(std::ssize(store.sessions()[0].frames.mapped_utimes), mapper.frames);
  EXPECT_EQ(store.sessions()[0].frames.mapped_utimes[1], 1'033'333);
  ASSERT_EQ(std::ssize(store.sessions()[0].frames.tracked_only_utimes),
            mapper.frames / kTrackedOnlyStep);
  EXPECT_EQ(store.sessions()[0].frames.tracked_only_utimes[0], 1'133'332);
  EXPECT_TRUE(store.sessions()[0].last_status);
}

class StoreLimits : public ::testing::TestWithParam<bool> {
 protected:
  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "run.lcm";
  const SessionStore::Config config_ = config_for(path_, GetParam());
};
INSTANTIATE_TEST_SUITE_P(Durable, StoreLimits, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "yes" : "no"; });

TEST_P(StoreLimits, KeepTheFilesSmallAndTheMapWhole) {
  std::int64_t sent = 0;
  {
    std::optional<SessionStore> opened(std::in_place, config_);
    SessionStore& store = *opened;
    store.begin_session(kSession, {{"device", "a"}});
    Mapper mapper(store);
    step_until_rewritten(mapper, store, path_, 4);
    sent = store.stream(channels::kCloudSlice, kSession).next_sequence();
    EXPECT_LT(std::ssize(store.stream(channels::kCloudSlice, kSession).replaced(0, SIZE_MAX)),
              sent);
    EXPECT_THAT(store.report().problem, IsEmpty());
    EXPECT_LT(store.report().size_bytes, kLimit);
    EXPECT_TRUE(wait_until(
        [&] { return store.report().size_bytes == bytes_of_files(path_.parent_path()); }));
    expect_whole(store, mapper);
    opened.reset();
    expect_resumable(path_, mapper);
  }
  EXPECT_GT(sent, 500) << "a run in which something was removed";
}

TEST_P(StoreLimits, GoOnInALogThatIsContinued) {
  std::int64_t frames = 0;
  ReceivedMap map;
  {
    SessionStore store(config_);
    store.begin_session(kSession, {{"device", "a"}});
    Mapper mapper(store);
    step_until_rewritten(mapper, store, path_, 1);
    map = mapper.map;
    frames = mapper.frames;
  }
  std::optional<SessionStore> opened(std::in_place, continued(config_));
  SessionStore& store = *opened;
  Mapper mapper(store);
  // Patches with other ids than before: the map grows by them.
  mapper.map = map;
  for (int i = 0; i < 50; ++i) {
    CloudSlice slice = example_patch(100, 1'000 + i);
    slice.correction = 0;
    mapper.send(slice);
  }
  mapper.frames = frames;
  expect_whole(store, mapper);
  opened.reset();
  expect_resumable(path_, mapper);
}

/// A kill leaves one of these, see BufferedLog::replace_first().
TEST_P(StoreLimits, LeaveAWholeLogWhereverTheyAreKilled) {
  const TemporaryFolder full;
  SessionStore::Config without = config_;
  without.max_total_bytes = 0;
  without.max_file_bytes = kMinFileBytes;
  without.path = full / "run.lcm";
  std::optional<SessionStore> store(std::in_place, without);
  store->begin_session(kSession, {{"device", "a"}});
  Mapper mapper(*store);
  while (store->report().size_bytes < kLimit) {
    mapper.step();
    ASSERT_TRUE(wait_until([&] { return store->report().waiting_bytes < 100'000; }));
  }
  store.reset();
  const std::set<std::string> all = files_in(full.path());

  {  // before the base is whole
    const TemporaryFolder killed;
    fs::copy(full.path(), killed.path());
    std::ofstream(killed / ".run.base.lcm") << "half of it";
    expect_resumable(killed / "run.lcm", mapper);
    EXPECT_EQ(files_in(killed.path()), all);
  }
  const TemporaryFolder limited;
  fs::copy(full.path(), limited.path());
  store.emplace(continued(config_for(limited / "run.lcm", GetParam())));
  store->retry();
  ASSERT_TRUE(wait_until([&] { return is_rewritten(limited / "run.lcm"); }));
  store.reset();
  const std::set<std::string> left = files_in(limited.path());
  ASSERT_LT(left.size() + 1, all.size());
  for (const std::size_t num_removed : {0, 1, 2}) {  // after that
    const TemporaryFolder killed;
    fs::copy(full.path(), killed.path());
    fs::copy(limited.path(), killed.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    for (std::size_t i = 1; i <= num_removed; ++i) {
      fs::remove(killed / ("run." + std::to_string(i) + ".lcm"));
    }
    expect_resumable(killed / "run.lcm", mapper);
    EXPECT_EQ(files_in(killed.path()), left) << num_removed;
  }
}

/// As on a full disk, of which the log itself needs what is left.
TEST_P(StoreLimits, LeaveNoHalfABase) {
  std::optional<SessionStore> store(std::in_place, config_);
  store->begin_session(kSession, {{"device", "a"}});
  Mapper mapper(*store);
  while (!fs::exists(folder_ / "run.2.lcm")) mapper.step();
  fs::resize_file(folder_ / "run.1.lcm", 10);  // so that it cannot be rewritten
  while (step_if_there_is_room(mapper, *store)) {
  }
  store->retry();
  store.reset();
  EXPECT_FALSE(fs::exists(folder_ / ".run.base.lcm"));
  EXPECT_TRUE(fs::exists(folder_ / "run.1.lcm"));
}

TEST_P(StoreLimits, NeverLoseAMapThatIsLargerAndSaySo) {
  SessionStore store(config_);
  store.begin_session(kSession, {{"device", "a"}});
  Mapper mapper(store);
  for (std::int32_t id = 0; id < 400; ++id) {
    CloudSlice slice = example_patch(600, id);
    slice.correction = 0;
    mapper.send(slice);
    store.retry();
    ASSERT_TRUE(wait_until([&] { return store.report().waiting_bytes < 100'000; }));
  }
  ASSERT_TRUE(wait_until([&] {
    store.retry();
    return !store.report().problem.empty();
  }));
  EXPECT_THAT(store.report().problem, HasSubstr("too much for --store-limit; all of it is kept"));
  expect_whole(store, mapper);
}

TEST(StoreLimit, AlsoWorksWithoutANameForTheLog) {
  SessionStore store(config_for(""));
  store.begin_session(kSession, {{"device", "a"}});
  Mapper mapper(store);
  bool has_shrunk = false;
  ASSERT_TRUE(wait_until([&] {
    const std::int64_t before = store.report().size_bytes;
    mapper.step();
    store.retry();
    has_shrunk |= store.report().size_bytes < before;
    return has_shrunk;
  }));
  expect_whole(store, mapper);
}

TEST(StoreLimit, TheRewrittenLogTellsEveryReaderWhatIsReplaced) {
  const TemporaryFolder folder;
  const fs::path path = folder / "run.lcm";
  SessionStore store(config_for(path));
  store.begin_session(kSession, {{"device", "a"}});
  Mapper mapper(store);
  step_until_rewritten(mapper, store, path, 2);
  store.finish();
  ReceivedMap map;
  StreamSubscriber<CloudSlice> subscriber(channels::kCloudSlice,
                                          [&](const CloudSlice& slice) { map.take(slice); });
  // All files, one after the other, as lcm-logplayer would play them.
  std::map<int, std::string> names;
  for (const std::string& name : files_in(folder.path())) {
    names[name == "run.lcm" ? 0 : std::stoi(name.substr(4))] = name;
  }
  for (const auto& [number, name] : names) {
    LogReader reader(folder / name, MessageTrust{});
    while (const auto event = reader.next()) subscriber.handle(event->channel, event->data);
    EXPECT_FALSE(reader.damage());
  }
  EXPECT_EQ(subscriber.counts().chunks_missing, 0);
  expect_same_map(map, mapper.map);
}

}  // namespace
}  // namespace kintsugi::mapper
