// The bus library: a client has the same points and labels as the segmenter, whatever the order in
// which messages come.

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/library/followed_pieces.hpp"
#include "segmenter/library/map_follower.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kMapSession = 7;
constexpr std::int64_t kSegmenterSession = 8;

CloudSlice slice(std::int32_t id, std::int32_t revision, SliceKind kind = SliceKind::kPatch) {
  CloudSlice slice;
  slice.utime = std::int64_t{1'000} * (id + 10 * revision);
  slice.session = kMapSession;
  slice.map_name = "map";
  slice.id = id;
  slice.revision = revision;
  slice.kind = kind;
  slice.resolution_m = 0.01F;
  return slice;
}

/// A patch of 10 x 10 points, 1 cm apart, with the corner at (x_m, 0, 1).
CloudSlice patch(std::int32_t id, std::int32_t revision, float x_m) {
  CloudSlice made = slice(id, revision);
  for (int i = 0; i < 100; ++i) {
    const int row = i / 10;
    CloudPoint& point = made.points_W.emplace_back();
    point.x = x_m + 0.01F * static_cast<float>(i % 10);
    point.y = 0.01F * static_cast<float>(row);
    point.z = 1.0F;
    point.nz = -1.0F;
  }
  return made;
}

CloudSlice correction(std::int32_t id, std::int32_t number, std::int32_t patch_id, double x_m) {
  CloudSlice made = slice(id, 0, SliceKind::kCorrection);
  made.correction = number;
  made.motions.push_back({patch_id, Pose(Eigen::Translation3d(x_m, 0.0, 0.0))});
  return made;
}

/// A session of mapper and segmenter: segments grow, merge and split, patches are revised and
/// moved.
struct Played {
  std::vector<CloudSlice> slices{patch(0, 0, 0.0F),         patch(1, 0, 0.1F),
                                 patch(2, 0, 1.0F),         patch(1, 1, 0.5F),
                                 correction(3, 1, 2, -0.9), patch(4, 0, 2.0F),
                                 patch(2, 1, 1.0F),         correction(5, 2, 2, 3.0),
                                 patch(1, 2, 0.1F),         slice(6, 0, SliceKind::kFinal)};
  std::vector<SegmentUpdate> updates;
  segmenter::SegmentMap map{{}, kSegmenterSession, slices.front()};

  Played() {
    slices.back().revision_sum = 3;
    for (const CloudSlice& slice : slices) {
      updates.push_back(map.add({&slice, 1}).front());
      updates.back().sequence = static_cast<std::int64_t>(updates.size()) - 1;
    }
  }
};

void expect_equal(const segmenter::FollowedPieces& pieces, const segmenter::SegmentMap& map) {
  const std::vector<std::int32_t> ids = pieces.ids();
  for (const SegmentUpdate& state : map.describe()) {
    const segmenter::SliceRecord& record = *map.cloud().find_slice(state.slice_id);
    if (!std::ranges::binary_search(ids, state.slice_id)) {
      ASSERT_EQ(record.count, 0U);  // a correction
      continue;
    }
    const auto points_W = map.cloud().points_W().subspan(record.first, record.count);
    EXPECT_EQ(*pieces.points_W(state.slice_id),
              std::vector<CloudPoint>(points_W.begin(), points_W.end()));
    EXPECT_EQ(pieces.labels(state.slice_id), state.labels) << "piece " << state.slice_id;
  }
}

TEST(FollowedPieces, EqualTheSegmentMapInAnyOrderOfSlicesAndUpdates) {
  const Played played;
  std::vector<int> order(2 * played.slices.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    segmenter::FollowedPieces pieces;
    std::set<std::int32_t> changed;
    for (const int which : order) {
      const auto i = static_cast<std::size_t>(which / 2);
      if (which % 2 == 0) {
        pieces.add(played.slices[i], changed);
      } else {
        pieces.apply(played.updates[i], changed);
      }
    }
    expect_equal(pieces, played.map);
    EXPECT_THAT(changed, ElementsAre(0, 1, 2, 4, 6));
    std::shuffle(order.begin(), order.end(), random);
  }
}

TEST(FollowedPieces, HaveNoSegmentsUntilThoseOfANewSegmenterArrive) {
  Played played;
  segmenter::FollowedPieces pieces;
  std::set<std::int32_t> changed;
  for (const CloudSlice& slice : played.slices) pieces.add(slice, changed);
  EXPECT_THAT(pieces.labels(0), Each(kNoSegment));
  for (const SegmentUpdate& update : played.updates) pieces.apply(update, changed);
  EXPECT_THAT(pieces.labels(0), Each(1U));
  SegmentUpdate restarted = played.updates.back();
  restarted.session += 1;
  changed.clear();
  pieces.apply(restarted, changed);
  EXPECT_THAT(pieces.labels(0), Each(kNoSegment));
  EXPECT_THAT(changed, ::testing::Contains(0));
  pieces.apply(played.updates.front(), changed);  // of the old one
  EXPECT_THAT(pieces.labels(0), Each(kNoSegment));
}

TEST(FollowedPieces, ChangeOnlyIfTheyHaveComeWhenANewSegmenterBegins) {
  const Played played;
  segmenter::FollowedPieces pieces;
  std::set<std::int32_t> changed;
  for (const SegmentUpdate& update : played.updates) pieces.apply(update, changed);
  pieces.add(played.slices.front(), changed);
  changed.clear();
  SegmentUpdate restarted = played.updates.back();
  restarted.session += 1;
  pieces.apply(restarted, changed);
  EXPECT_THAT(changed, ElementsAre(0));
}

TEST(FollowedPieces, KnowThatPointsAreMissing) {
  const Played played;
  segmenter::FollowedPieces pieces;
  std::set<std::int32_t> changed;
  for (const SegmentUpdate& update : played.updates) pieces.apply(update, changed);
  for (const CloudSlice& slice : played.slices) {
    EXPECT_EQ(pieces.num_without_points() > 0, slice.id < 6);  // the last but one is a patch
    EXPECT_FALSE(pieces.has_final());
    pieces.add(slice, changed);
  }
  EXPECT_EQ(pieces.num_without_points(), 0);
  EXPECT_TRUE(pieces.has_final());
}

TEST(FollowedPieces, IgnoreRunsBeyondThePieceAndRefuseUnknownPieces) {
  Played played;
  segmenter::FollowedPieces pieces;
  std::set<std::int32_t> changed;
  pieces.add(played.slices.front(), changed);
  SegmentUpdate update = played.updates.front();
  update.runs = {{0, 99, 2, 5, 0}, {0, -1, 2, 5, 0}, {0, 0, 0, 5, 0}};
  pieces.apply(update, changed);
  EXPECT_THAT(pieces.labels(0), Each(1U));
  EXPECT_THROW((void)pieces.labels(9), std::invalid_argument);
  EXPECT_THROW((void)pieces.points_W(9), std::invalid_argument);
}

template <class Message>
void append(LogWriter& log, const std::string& channel, const Message& message,
            std::int64_t sequence) {
  const std::int32_t count = num_chunks(message, kDefaultMaxChunkBytes);
  ASSERT_EQ(count, 1);
  log.append(1, channel, encode_chunk(message, sequence, 0, kDefaultMaxChunkBytes));
}

/// Handles messages as they come, without a bus.
class Follower {
 public:
  template <class Message>
  void take(const std::string& channel, const Message& message, std::int64_t sequence) {
    follower_.handle(channel, encode_chunk(message, sequence, 0, kDefaultMaxChunkBytes), now_s_);
  }
  void take(const std::string& channel, const Bytes& message) {
    follower_.handle(channel, message, now_s_);
  }

  void pass(double seconds) { now_s_ += seconds; }

  segmenter::MapFollower* operator->() { return &follower_; }

 private:
  segmenter::MapFollower follower_{MapClientOptions{.map_name = "map"}};
  double now_s_ = 0.0;
};

CameraPose camera_pose(std::int64_t session, std::int64_t frame) {
  CameraPose pose;
  pose.session = session;
  pose.frame_index = frame;
  return pose;
}

MATCHER_P2(IsPose, session, frame, "") {
  return arg.session == session && arg.frame_index == frame;
}

TEST(MapFollower, HasTheCameraOfItsMap) {
  const Played played;
  Follower follower;
  const auto take = [&](std::int64_t session, std::int64_t frame) {
    follower.take(channels::kCameraPose, encode(camera_pose(session, frame)));
  };
  take(kMapSession + 20, 8);  // of another map
  take(kMapSession, 0);       // which map it is of is not known yet
  EXPECT_FALSE(follower->camera());
  EXPECT_FALSE(follower->has_changes());
  follower.take(channels::kSegmentUpdate, played.updates.front(), 0);
  ASSERT_TRUE(follower->camera());
  EXPECT_THAT(*follower->camera(), IsPose(kMapSession, 0));
  take(kMapSession - 1, 9);
  take(kMapSession, 1);
  take(kMapSession + 10, 0);  // the mapper is started again
  EXPECT_THAT(follower->take_changes().poses,
              ElementsAre(IsPose(kMapSession, 0), IsPose(kMapSession, 1)));
  SegmentUpdate update = played.updates.front();
  update.map_session = kMapSession + 10;
  update.session += 10;
  follower.take(channels::kSegmentUpdate, update, 0);
  EXPECT_THAT(*follower->camera(), IsPose(kMapSession + 10, 0));
  update.map_session = kMapSession + 11;
  update.session += 1;
  follower.take(channels::kSegmentUpdate, update, 0);
  EXPECT_FALSE(follower->camera());
}

TEST(MapFollower, TellsOfThePiecesOfTheNewestSessionOnly) {
  const Played played;
  Follower follower;
  for (std::int64_t i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    follower.take(channels::kCloudSlice, played.slices[k], i);
    follower.take(channels::kSegmentUpdate, played.updates[k], i);
  }
  // The mapper is started again. Its first pieces come before the first update, which tells that
  // they are of the map.
  for (const std::int32_t id : {0, 5}) {
    CloudSlice piece = patch(id, 0, 0.0F);
    piece.session = kMapSession + 10;
    follower.take(channels::kCloudSlice, piece, id);
  }
  EXPECT_THAT(follower->pieces().ids(), ElementsAre(0, 1, 2));
  SegmentUpdate update = played.updates.front();
  update.map_session = kMapSession + 10;
  update.session = kMapSession + 11;
  follower.take(channels::kSegmentUpdate, update, 0);
  EXPECT_THAT(follower->pieces().ids(), ElementsAre(0, 5));
  EXPECT_THAT(follower->take_changes().pieces, ElementsAre(0, 5));
}

class MapClientOfALog : public ::testing::Test {
 protected:
  /// Each slice but `lost`, the camera at it, and its update; then messages about objects.
  void write(const Played& played, const std::vector<Bytes>& objects = {},
             const std::set<std::int64_t>& lost = {}) {
    LogWriter log = LogWriter::create(path_);
    for (std::size_t i = 0; i < played.slices.size(); ++i) {
      const auto sequence = static_cast<std::int64_t>(i);
      if (!lost.contains(sequence)) {
        append(log, channels::kCloudSlice, played.slices[i], sequence);
      }
      CameraPose pose;
      pose.session = kMapSession;
      pose.frame_index = sequence;
      log.append(1, channels::kCameraPose, encode(pose));
      append(log, channels::kSegmentUpdate, played.updates[i], sequence);
    }
    for (const Bytes& message : objects) log.append(1, channels::kObjectDetection, message);
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "run.lcm";
};

TEST_F(MapClientOfALog, HasTheMapAtItsEnd) {
  const Played played;
  write(played);
  const MapClient client = read_log(path_);
  EXPECT_TRUE(client.is_mapped());
  EXPECT_TRUE(client.is_complete());
  EXPECT_TRUE(client.has_ended());
  EXPECT_THAT(client.problem(), IsEmpty());
  EXPECT_THAT(client.damage(), IsEmpty());
  EXPECT_THAT(client.dropped(), IsEmpty());
  EXPECT_EQ(client.segments(), played.map.statistics().all());
  EXPECT_THAT(client.pieces(), ElementsAre(0, 1, 2, 4, 6));
  EXPECT_THAT(client.labels(0), Each(1U));
  EXPECT_EQ(client.newest_update()->map_name, "map");
  EXPECT_EQ(client.camera()->frame_index, 9);
  ASSERT_TRUE(client.birth(1));
  EXPECT_EQ(client.birth(1)->slice_id, 0);
  EXPECT_FALSE(client.birth(1'000));
}

TEST_F(MapClientOfALog, TellsOfEachChange) {
  const Played played;
  write(played);
  MapClient client = MapClient::open_log(path_);
  std::size_t num_updates = 0;
  std::size_t num_poses = 0;
  bool has_moved = false;
  while (!client.has_ended()) {
    const MapChanges changes = client.wait(MapClient::Seconds(0.0));
    num_updates += changes.updates.size();
    num_poses += changes.poses.size();
    has_moved = has_moved || (changes.pieces == std::vector{2} && changes.updates.empty());
  }
  EXPECT_EQ(num_updates, played.updates.size());
  EXPECT_EQ(num_poses, played.slices.size());
  EXPECT_TRUE(has_moved);
  EXPECT_TRUE(client.wait(MapClient::Seconds(0.0)).is_empty());
}

ObjectDetection detected(std::int32_t number, const std::string& name, DetectionEvent event) {
  ObjectDetection detection;
  detection.session = 3;
  detection.map_session = kMapSession;
  detection.map_name = "map";
  detection.detection = number;
  detection.num_detections = 3;
  detection.event_number = number;
  detection.event = event;
  detection.name = name;
  return detection;
}

TEST_F(MapClientOfALog, HasTheObjectsThatAreInTheMap) {
  ObjectDetection of_another_map = detected(3, "chair", DetectionEvent::kFound);
  of_another_map.map_name = "cellar";
  of_another_map.event_number = 9;
  write(Played(),
        {encode(detected(1, "mug", DetectionEvent::kConfirmed)),
         encode(detected(2, "globe", DetectionEvent::kGone)),
         encode(detected(3, "mug", DetectionEvent::kFound)), encode(of_another_map), Bytes(40, 1)});
  const std::vector<ObjectDetection> objects = read_log(path_).objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].detection, 1);
  EXPECT_EQ(objects[1].detection, 3);
  EXPECT_EQ(objects[1].name, "mug");
}

TEST(MapFollower, ForgetsTheObjectsOfADetectorThatBeganAnew) {
  Follower follower;
  follower.take(channels::kSegmentUpdate, Played().updates.front(), 0);
  const ObjectDetection mug = detected(1, "mug", DetectionEvent::kFound);
  follower.take(channels::kObjectDetection, encode(mug));
  DetectorStatus status;
  status.session = mug.session + 1;
  status.map_session = kMapSession;
  status.map_name = "cellar";
  follower.take(channels::kDetectorStatus, encode(status));
  EXPECT_THAT(follower->objects(), SizeIs(1));
  status.map_name = "map";
  follower.take(channels::kDetectorStatus, encode(status));
  EXPECT_THAT(follower->objects(), IsEmpty());
}

TEST(MapFollower, ForgetsAnObjectThatIsNotRepeatedWhileTheDetectorIsHeard) {
  Follower follower;
  follower.take(channels::kSegmentUpdate, Played().updates.front(), 0);
  const ObjectDetection mug = detected(1, "mug", DetectionEvent::kFound);
  follower.take(channels::kObjectDetection, encode(mug));
  DetectorStatus status;
  status.session = mug.session;
  status.map_session = kMapSession;
  status.map_name = "map";
  follower.pass(ObjectTable::kSilence_s + 1.0);
  EXPECT_THAT(follower->objects(), SizeIs(1));
  follower.take(channels::kDetectorStatus, encode(status));
  EXPECT_THAT(follower->objects(), IsEmpty());
}

TEST_F(MapClientOfALog, CanLeaveThePointsAway) {
  const Played played;
  write(played);
  const MapClient client = read_log(path_, {.with_points = false});
  EXPECT_THAT(client.pieces(), IsEmpty());
  EXPECT_EQ(client.segments(), played.map.statistics().all());
}

TEST_F(MapClientOfALog, FollowsTheMapWithTheNameThatIsGiven) {
  write(Played());
  const MapClient client = read_log(path_, {.map_name = "another"});
  EXPECT_THAT(client.pieces(), IsEmpty());
  EXPECT_THAT(client.problem(), HasSubstr("no segment update was received"));
}

TEST_F(MapClientOfALog, IsReadInStepsWhereNothingChanges) {
  write(Played());
  MapClient client = MapClient::open_log(path_, {.map_name = "another"});
  EXPECT_TRUE(client.wait(MapClient::Seconds(0.0)).is_empty());
  EXPECT_FALSE(client.has_ended());
  EXPECT_TRUE(client.wait(MapClient::Seconds(1'000.0)).is_empty());
  EXPECT_TRUE(client.has_ended());
}

TEST_F(MapClientOfALog, SaysThatPointsAreMissing) {
  write(Played(), {}, {0, 5});
  EXPECT_THAT(read_log(path_).problem(), HasSubstr("the points of 2 pieces are missing"));
  EXPECT_THAT(read_log(path_, {.with_points = false}).problem(), IsEmpty());
}

TEST_F(MapClientOfALog, SaysThatACorrectionIsMissing) {
  write(Played(), {}, {7});
  EXPECT_THAT(read_log(path_).problem(), HasSubstr("slices are missing"));
}

TEST_F(MapClientOfALog, SaysWhatIsWrong) {
  write(Played());
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 10);
  MapClient client = read_log(path_);
  EXPECT_THAT(client.damage(), HasSubstr("is damaged at byte"));
  EXPECT_THROW((void)client.ask({}), std::runtime_error);
  EXPECT_THROW(read_log(folder_ / "none"), std::runtime_error);
}

}  // namespace
}  // namespace kintsugi
