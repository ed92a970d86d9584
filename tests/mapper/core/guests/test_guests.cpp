// Two mappers in one building, without a bus.

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "mapper/core/mapper_pipeline.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using testing::synthetic_run;
using testing::SyntheticRun;

constexpr std::int64_t kGuest = 8;  // its session
constexpr int kFrames = 130;        // of each mapper
constexpr int kStep = 4;
constexpr int kLater = 40;  // frames that the guest begins later on the same way

MapperPipeline::Config config(double resolution_m = 0.015) {
  MapperPipeline::Config config;
  config.patch_side_m = 0.25;
  config.volume.resolution_m = resolution_m;
  return config;
}

/// What a mapper with --join sends.
struct Sent {
  std::vector<KeyframeMessage> keyframes;
  std::vector<CloudSlice> slices;
};

/// Through the codec and back.
KeyframeMessage received(KeyframeMessage keyframe) {
  keyframe.session = kGuest;
  keyframe.map_name = "guest";
  keyframe.join = "host";
  std::vector<Chunk<KeyframeMessage>> chunks;
  const std::int32_t count = num_chunks(keyframe, kDefaultMaxChunkBytes);
  for (std::int32_t i = 0; i < count; ++i) {
    chunks.push_back(
        decode_chunk<KeyframeMessage>(encode_chunk(keyframe, i, i, kDefaultMaxChunkBytes)));
  }
  return join(chunks);
}

Sent guest_in(const SyntheticRun& run) {
  MapperPipeline pipeline(config());
  Sent sent;
  const auto take = [&](std::vector<CloudSlice> slices) {
    for (CloudSlice& slice : slices) {
      slice.session = kGuest;
      sent.slices.push_back(std::move(slice));
    }
  };
  const auto take_keyframe = [&] {
    if (auto keyframe = pipeline.take_keyframe()) {
      sent.keyframes.push_back(received(*std::move(keyframe)));
    }
  };
  for (const RgbdFrame& frame : run.frames) {
    take_keyframe();
    take(pipeline.process(frame).slices);
  }
  take_keyframe();
  take(pipeline.finish());
  return sent;
}

/// What a receiver of all slices has in the end, with their place in it.
std::vector<CloudSlice> received_map(std::vector<CloudSlice> slices) {
  std::map<std::int32_t, CloudSlice> newest;
  for (CloudSlice& slice : slices) {
    const auto known = newest.find(slice.id);
    if (known == newest.end() || known->second.revision < slice.revision) {
      newest.insert_or_assign(slice.id, std::move(slice));
    }
  }
  std::vector<CloudSlice*> pointers;
  for (auto& [id, slice] : newest) pointers.push_back(&slice);
  apply_corrections(pointers);
  std::vector<CloudSlice> map;
  for (auto& [id, slice] : newest) map.push_back(std::move(slice));
  return map;
}

std::vector<Eigen::Vector3d> points_of(const std::vector<CloudSlice>& map,
                                       const std::function<bool(const CloudSlice&)>& is_chosen) {
  std::vector<Eigen::Vector3d> points;
  for (const CloudSlice& slice : map) {
    if (!is_chosen(slice)) continue;
    for (const CloudPoint& p : slice.points_W) points.emplace_back(p.x, p.y, p.z);
  }
  return points;
}

bool is_of_guest(const CloudSlice& slice) {
  return slice.kind == SliceKind::kPatch && slice.keyframe == -1;
}

/// Of every twentieth of these points, the share that has another one within a distance.
double share_near(const std::vector<Eigen::Vector3d>& points,
                  const std::vector<Eigen::Vector3d>& others, double distance_m) {
  int num_near = 0;
  int num_points = 0;
  for (std::size_t i = 0; i < points.size(); i += 20) {
    ++num_points;
    num_near += std::ranges::any_of(others, [&](const Eigen::Vector3d& other) {
      return (points[i] - other).squaredNorm() <= distance_m * distance_m;
    });
  }
  return static_cast<double>(num_near) / num_points;
}

struct Host {
  explicit Host(double resolution_m = 0.015) : pipeline(config(resolution_m)) {}

  /// Maps the run; after these frames what the guest has sent is there, in any order.
  void map(const SyntheticRun& run, Sent sent, std::size_t num_frames_before = 10) {
    std::mt19937 random(1);
    std::ranges::shuffle(sent.keyframes, random);
    std::ranges::shuffle(sent.slices, random);
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
      if (i == num_frames_before) add_guest(sent);
      std::ranges::move(pipeline.process(run.frames[i]).slices, std::back_inserter(slices));
      most_parts = std::max(most_parts, pipeline.num_parts());
    }
    if (run.frames.size() == num_frames_before) add_guest(sent);
    std::ranges::move(pipeline.finish(), std::back_inserter(slices));
  }

  void add_guest(Sent& sent) {
    for (KeyframeMessage& keyframe : sent.keyframes) pipeline.add_guest(std::move(keyframe));
    for (CloudSlice& slice : sent.slices) pipeline.add_guest(std::move(slice));
  }

  MapperPipeline pipeline;
  std::vector<CloudSlice> slices;
  int most_parts = 0;
};

class GuestsTest : public ::testing::Test {
 protected:
  const SyntheticRun first = synthetic_run("loop", kFrames, true, kStep);
};

TEST_F(GuestsTest, BecomeOneMapWithThatOfTheHost) {
  const SyntheticRun later = synthetic_run("loop", kFrames, true, kStep, kLater * kStep);
  const Sent sent = guest_in(later);
  Host host;
  host.map(first, sent);
  EXPECT_EQ(host.most_parts, 2) << "apart at first";
  EXPECT_EQ(host.pipeline.num_parts(), 1);
  const std::vector<GuestReport> reports = host.pipeline.guests().reports();
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0].session, kGuest);
  EXPECT_EQ(reports[0].map_name, "guest");
  EXPECT_EQ(reports[0].keyframes, static_cast<int>(sent.keyframes.size()));

  // All surface of the guest is there, where its way began on that of the host.
  const std::vector<CloudSlice> map = received_map(host.slices);
  const auto is_any = [](const CloudSlice&) { return true; };
  const auto all = points_of(map, is_any);
  auto there = points_of(received_map(sent.slices), is_any);
  ASSERT_GT(there.size(), 10'000U);
  const Pose X_HG = first.true_path[0].X_WC.inverse() * later.true_path[0].X_WC;
  for (Eigen::Vector3d& p : there) p = X_HG * p;
  EXPECT_GT(share_near(there, all, 0.03), 0.99);

  // And once, where both have seen it.
  const auto of_host = points_of(map, std::not_fn(is_of_guest));
  const auto of_guest = points_of(map, is_of_guest);
  EXPECT_GT(share_near(there, of_host, 0.03), 0.3) << "both have seen it";
  EXPECT_LT(share_near(of_guest, of_host, 0.015), 0.02);
  for (const CloudSlice& slice : map) {
    EXPECT_EQ(slice.part, 0);
  }

  // Numbered and summed up like a map of one mapper.
  const CloudSlice& last = host.slices.back();
  EXPECT_EQ(last.kind, SliceKind::kFinal);
  ASSERT_EQ(map.size(), static_cast<std::size_t>(last.id) + 1);
  std::int64_t revision_sum = 0;
  for (const CloudSlice& slice : map) revision_sum += slice.revision;
  EXPECT_EQ(revision_sum, last.revision_sum);
}

TEST_F(GuestsTest, BecomeOneMapAlsoWhenTheyComeAtTheEnd) {
  Host host;
  host.map(first, guest_in(synthetic_run("loop", kFrames, true, kStep, kLater * kStep)),
           first.frames.size());
  EXPECT_EQ(host.most_parts, 1) << "before the end";
  EXPECT_EQ(host.pipeline.num_parts_begun(), 2);
  EXPECT_EQ(host.pipeline.num_parts(), 1);
  const auto map = received_map(host.slices);
  EXPECT_LT(
      share_near(points_of(map, is_of_guest), points_of(map, std::not_fn(is_of_guest)), 0.015),
      0.02)
      << "what both have seen is there once";
}

TEST_F(GuestsTest, StayAPartOfTheirOwnWhereNobodyElseWas) {
  const Sent sent = guest_in(synthetic_run("kitchen", kFrames, true, kStep));
  Host host;
  host.map(first, sent);
  EXPECT_EQ(host.pipeline.num_parts(), 2);
  for (const CloudSlice& slice : received_map(host.slices)) {
    EXPECT_EQ(slice.part, is_of_guest(slice) ? 1 : 0) << "never a mixture";
  }
}

TEST_F(GuestsTest, WithOtherVoxelsAreRefused) {
  Host host(0.02);
  host.map(first, guest_in(synthetic_run("loop", 20, true, kStep)));
  const std::vector<GuestReport> reports = host.pipeline.guests().reports();
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_THAT(reports[0].problem, HasSubstr("its voxels are 15.00 mm, those of this map 20.00 mm"));
  EXPECT_EQ(host.most_parts, 1);
  EXPECT_TRUE(points_of(host.slices, is_of_guest).empty());
}

TEST_F(GuestsTest, AreNotTakenTwiceFromThoseThatHaveGuestsThemselves) {
  // A patch that the sender has taken from a guest of its own has no keyframe of its camera.
  Sent sent = guest_in(synthetic_run("loop", 20, true, kStep));
  for (CloudSlice& slice : sent.slices) slice.keyframe = -1;
  Host host;
  host.map(first, sent);
  EXPECT_TRUE(points_of(host.slices, is_of_guest).empty());
}

}  // namespace
}  // namespace kintsugi::mapper
