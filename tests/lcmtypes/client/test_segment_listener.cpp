#include <algorithm>
#include <cstddef>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/client/segment_listener.hpp"
#include "lcmtypes/client/segment_table_text.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kChunkBytes = kMinMaxChunkBytes;
constexpr std::int64_t kSession = 50;

SegmentUpdate an_update(std::int32_t slice_id, std::uint32_t num_segments) {
  SegmentUpdate update;
  update.session = kSession;
  update.map_session = 7;
  update.map_name = "map";
  update.slice_id = slice_id;
  update.num_slices = slice_id + 1;
  update.num_segments = num_segments;
  return update;
}

SegmentUpdate telling(SegmentUpdate update, const std::vector<std::uint32_t>& ids) {
  for (const std::uint32_t id : ids) {
    update.statistics.emplace_back().segment_id = id;
    update.statistics.back().num_points = 10;
  }
  return update;
}

/// The update of slice n creates segments 40n + 1 to 40n + 40, and merges those of the slice before
/// into the first of them. Each update has several chunks.
SegmentUpdate update_of(std::int32_t slice_id) {
  constexpr std::uint32_t kNew = 40;
  const auto first = static_cast<std::uint32_t>(slice_id) * kNew + 1;
  SegmentUpdate update = an_update(slice_id, kNew + static_cast<std::uint32_t>(slice_id));
  for (std::uint32_t id = first; id < first + kNew; ++id) {
    update.events.push_back({SegmentEventType::kCreated, id, 0});
    update.statistics.emplace_back().segment_id = id;
    update.statistics.back().num_points = id;
    if (slice_id > 0 && id > first) {
      update.events.push_back({SegmentEventType::kMerged, first - kNew, id - kNew});
    }
  }
  return update;
}

/// The LCM messages of updates that are published one after the other.
class Stream {
 public:
  void publish(const SegmentUpdate& update) {
    const std::int32_t count = num_chunks(update, kChunkBytes);
    for (std::int32_t i = 0; i < count; ++i) {
      messages_.push_back(encode_chunk(update, next_sequence(), i, kChunkBytes));
    }
  }
  std::int64_t next_sequence() const { return static_cast<std::int64_t>(messages_.size()); }
  const std::vector<Bytes>& messages() const { return messages_; }

 private:
  std::vector<Bytes> messages_;
};

class SegmentListenerTest : public ::testing::Test {
 protected:
  void hear(const Bytes& message) { listener_.handle(channels::kSegmentUpdate, message); }

  Stream stream_;
  std::vector<std::int32_t> slices_heard_;
  SegmentListener listener_{
      "", [this](const SegmentUpdate& update) { slices_heard_.push_back(update.slice_id); }};
};

TEST_F(SegmentListenerTest, HasTheSameTableForAnyOrderOfChunks) {
  for (std::int32_t slice = 0; slice < 6; ++slice) stream_.publish(update_of(slice));
  ASSERT_GE(stream_.next_sequence(), 3 * 6) << "expected several chunks an update";
  EXPECT_THAT(listener_.problem(), HasSubstr("no segment update"));
  std::vector<Bytes> messages = stream_.messages();
  std::shuffle(messages.begin(), messages.end(), std::mt19937(1));
  for (const Bytes& message : messages) hear(message);
  EXPECT_EQ(listener_.problem(), "");
  EXPECT_EQ(listener_.table().segments().size(), 45U);
  EXPECT_EQ(listener_.table().heir(2), 1U);
  EXPECT_EQ(slices_heard_.size(), 6U);
}

TEST_F(SegmentListenerTest, ReportsMissingUpdatesUntilAFullState) {
  for (std::int32_t slice = 0; slice < 4; ++slice) stream_.publish(update_of(slice));
  for (std::size_t i = 0; i < stream_.messages().size(); ++i) {
    if (i != 5) hear(stream_.messages()[i]);
  }
  EXPECT_THAT(listener_.problem(), HasSubstr("updates are missing"));

  SegmentUpdate state = telling(an_update(3, 2), {1, 150});
  state.is_final = true;
  EXPECT_FALSE(listener_.has_ended());
  stream_.publish(state);
  hear(stream_.messages().back());
  EXPECT_EQ(listener_.problem(), "");
  EXPECT_TRUE(listener_.has_ended());
  EXPECT_EQ(listener_.table().segments().size(), 2U);
}

TEST_F(SegmentListenerTest, ReportsMissingUpdatesAfterTheFullState) {
  stream_.publish(telling(an_update(0, 2), {1, 2}));
  stream_.publish(telling(an_update(1, 2), {2}));
  stream_.publish(telling(an_update(2, 2), {1}));
  hear(stream_.messages()[0]);
  hear(stream_.messages()[2]);
  ASSERT_TRUE(listener_.table().has_all_segments());
  EXPECT_FALSE(listener_.is_whole());
}

TEST_F(SegmentListenerTest, DropsMessagesWithAWrongChecksum) {
  stream_.publish(update_of(0));
  Bytes spoilt = stream_.messages()[0];
  spoilt.back() ^= 1U;
  hear(spoilt);
  EXPECT_THAT(listener_.dropped(), HasSubstr("messages dropped: 1"));
  EXPECT_THAT(listener_.dropped(), HasSubstr("checksum"));
  for (const Bytes& message : stream_.messages()) hear(message);
  EXPECT_EQ(listener_.problem(), "");
}

TEST_F(SegmentListenerTest, FollowsOneMapAndItsNewestSegmenter) {
  stream_.publish(update_of(0));
  for (const Bytes& message : stream_.messages()) hear(message);
  SegmentUpdate of_other_map = update_of(1);
  of_other_map.map_name = "other";
  of_other_map.map_session = 8;
  stream_.publish(of_other_map);
  for (const Bytes& message : stream_.messages()) hear(message);
  EXPECT_EQ(slices_heard_, std::vector<std::int32_t>{0});

  Stream restarted;
  SegmentUpdate of_restarted = an_update(4, 0);
  of_restarted.session = kSession + 1;
  restarted.publish(of_restarted);
  hear(restarted.messages()[0]);
  EXPECT_THAT(slices_heard_, ::testing::ElementsAre(0, 4));
  EXPECT_THAT(listener_.table().segments(), IsEmpty());
  EXPECT_EQ(listener_.problem(), "");
}

TEST(SegmentTableText, HasALineForEachEventWithItsSegments) {
  SegmentUpdate update = an_update(12, 3);
  update.num_points = 500;
  update.slice_revision = 2;
  update.events = {{SegmentEventType::kCreated, 8, 0},
                   {SegmentEventType::kGrown, 3, 0},
                   {SegmentEventType::kMerged, 3, 5},
                   {SegmentEventType::kSplit, 3, 9},
                   {SegmentEventType::kRetired, 6, 0}};
  for (const std::uint32_t id : {3U, 8U, 9U}) {
    SegmentStatistics& statistics = update.statistics.emplace_back();
    statistics.segment_id = id;
    statistics.num_points = 100 * id;
    statistics.centroid_W[0] = 0.5F;
  }
  const std::string summary =
      "slice 12 revision 2: 500 points, 3 segments; 1 created, 1 grown, 1 merged, 1 split, 1 "
      "retired\n";
  const std::string created = "  8 created: 800 points at 0.50 0.00 0.00 m\n";
  const std::string grown = "  3 grown: 300 points at 0.50 0.00 0.00 m\n";
  const std::string rest =
      "  5 merged into 3: 300 points at 0.50 0.00 0.00 m\n"
      "  9 split off 3: 900 points at 0.50 0.00 0.00 m\n"
      "  6 retired\n";
  EXPECT_EQ(update_text(update, true), summary + created + grown + rest);
  EXPECT_EQ(update_text(update, false), summary + created + rest);
  EXPECT_EQ(update_text(an_update(1, 3), true), "");

  SegmentTable table;
  EXPECT_EQ(table_text(table, 5), "no segment updates\n");
  table.apply(update);
  EXPECT_THAT(table_text(table, 2), HasSubstr("       9       900"));
  EXPECT_THAT(table_text(table, 2), HasSubstr("and 1 smaller ones\n"));
  std::ostringstream json;
  write_table_json(table, true, json);
  EXPECT_THAT(json.str(), HasSubstr(R"("born":{"slice":12,"parent":3})"));
}

}  // namespace
}  // namespace kintsugi
