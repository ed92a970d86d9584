// The views beside a saved map; a file that is none is refused.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/io/views_file.hpp"
#include "segmenter/views/packed_depth.hpp"
#include "tests/support/allocation_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::allocated_by;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

KeptView example_view(std::int64_t utime) {
  KeptView view;
  view.utime = utime;
  view.X_PC.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).matrix();
  view.X_WC.translation() << 1.0, 2.0, 3.0;
  view.intrinsics = {.fx = 4, .fy = 5, .cx = 1.5, .cy = 1, .width = 4, .height = 3};
  view.patch = 7;
  view.part = 1;
  std::vector<std::uint16_t> depth_mm(12, 1000);
  depth_mm[3] = static_cast<std::uint16_t>(utime);
  view.packed_depth = std::make_shared<const std::vector<std::uint8_t>>(pack_depth(depth_mm, 4));
  return view;
}

class ViewsFile : public ::testing::Test {
 protected:
  ViewsFile() {
    views_.map_session = 5;
    views_.map_name = "hall";
    views_.views = {example_view(100), example_view(200)};
    views_.views[1].patch = KeptView::kNoPatch;
    write_views(views_, path_);
    bytes_ = contents(path_);
  }

  void expect_refused(const std::string& bytes, const std::string& reason = "") {
    write(path_, bytes);
    EXPECT_THAT([&] { read_views(path_); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr("'" + path_.string() + "'"), HasSubstr(reason))));
  }
  /// Written as it is, with a right checksum.
  void expect_refused(const std::function<void(KeptView&)>& spoil, const std::string& reason) {
    ViewSet views = views_;
    spoil(views.views[1]);
    write_views(views, path_);
    expect_refused(contents(path_), reason);
  }

  kintsugi::testing::TemporaryFolder folder_;
  std::filesystem::path path_ = views_file_of(folder_ / "map.kseg");
  ViewSet views_;
  std::string bytes_;
};

TEST_F(ViewsFile, HoldsWhatWasWritten) {
  EXPECT_EQ(path_.filename(), "map.kseg.views");
  const ViewSet read = read_views(path_);
  EXPECT_EQ(read.map_session, 5);
  EXPECT_EQ(read.map_name, "hall");
  ASSERT_EQ(read.views.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const KeptView& was = views_.views[i];
    const KeptView& is = read.views[i];
    EXPECT_EQ(is.utime, was.utime);
    EXPECT_EQ(is.X_PC.matrix(), was.X_PC.matrix());
    EXPECT_EQ(is.X_WC.matrix(), was.X_WC.matrix());
    EXPECT_EQ(is.intrinsics, was.intrinsics);
    EXPECT_EQ(is.patch, was.patch);
    EXPECT_EQ(is.part, was.part);
    EXPECT_EQ(*is.packed_depth, *was.packed_depth);
  }
  write_views(read, folder_ / "again");
  EXPECT_EQ(contents(folder_ / "again"), bytes_);
  write_views({}, path_);
  EXPECT_TRUE(read_views(path_).views.empty());
}

TEST_F(ViewsFile, IsTheSameInMemory) {
  const std::vector<std::uint8_t> bytes = view_bytes(views_);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), bytes_);
  const ViewSet read = views_of_bytes(bytes, "the answer");
  write_views(read, path_);
  EXPECT_EQ(contents(path_), bytes_);
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    EXPECT_THAT([&] { views_of_bytes(std::span(bytes).first(size), "the answer"); },
                ThrowsMessage<std::runtime_error>(HasSubstr("the answer, byte ")));
  }
}

TEST_F(ViewsFile, BelongsToOneMap) {
  EXPECT_EQ(read_views_of(path_, 5, "hall").views.size(), 2U);
  EXPECT_THAT(
      [&] { read_views_of(path_, 6, "hall"); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path_.string()), HasSubstr("of session 5"),
                                              HasSubstr("expected session 6 of map 'hall'"))));
  EXPECT_THROW(read_views_of(path_, 5, "map"), std::runtime_error);
}

TEST_F(ViewsFile, IsRefusedWithAnyByteDamaged) {
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    std::string damaged = bytes_;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    expect_refused(damaged);
  }
}

TEST_F(ViewsFile, IsRefusedWhenCutOffAnywhereOrTooLong) {
  for (std::size_t size = 0; size < bytes_.size(); ++size) expect_refused(bytes_.substr(0, size));
  expect_refused(bytes_ + '\0');
  expect_refused(bytes_ + bytes_);
}

TEST_F(ViewsFile, ReasonsSayWhatWasExpected) {
  expect_refused("ply\nformat ascii 1.0\nand so on", "expected KVIEWS");
  std::string newer = bytes_;
  newer[8] = 2;
  expect_refused(newer, "version 2, expected 1");
  expect_refused(bytes_.substr(0, bytes_.size() - 3), "cut off");
  std::string damaged = bytes_;
  damaged[100] = static_cast<char>(damaged[100] ^ 1);
  expect_refused(damaged, "checksum");
  std::filesystem::remove(path_);
  EXPECT_THAT([&] { read_views(path_); }, ThrowsMessage<std::runtime_error>(HasSubstr("No such")));
}

TEST_F(ViewsFile, IsRefusedWhenItHasWhatNoViewHas) {
  expect_refused([](KeptView& v) { v.utime = 100; }, "view 1 is of time 100");
  expect_refused([](KeptView& v) { v.X_PC.matrix()(0, 0) = 2.0; }, "view 1 has poses");
  expect_refused([](KeptView& v) { v.X_WC.matrix()(1, 3) = NAN; }, "view 1 has poses");
  expect_refused([](KeptView& v) { v.X_WC.matrix()(1, 3) = 1e9; }, "view 1 has poses");
  expect_refused([](KeptView& v) { v.X_WC.matrix().row(0) *= -1.0; }, "view 1 has poses");
  expect_refused([](KeptView& v) { v.intrinsics.fx = 0.0; }, "view 1 has a camera");
  expect_refused([](KeptView& v) { v.intrinsics.cy = NAN; }, "view 1 has a camera");
  expect_refused([](KeptView& v) { v.intrinsics.width = 0; }, "view 1 has a camera");
  expect_refused([](KeptView& v) { v.intrinsics.height = 5000; }, "view 1 has a camera");
  expect_refused([](KeptView& v) { v.intrinsics.height = 4; }, "view 1: its");
  expect_refused([](KeptView& v) { v.intrinsics.height = v.intrinsics.width = 4096; },
                 "too few for 4096 x 4096");
  expect_refused([](KeptView& v) { v.patch = -2; }, "patch -2");
  expect_refused([](KeptView& v) { v.part = -1; }, "part -1");
  expect_refused(
      [](KeptView& v) {
        v.packed_depth = std::make_shared<const std::vector<std::uint8_t>>(40, 120);
      },
      "view 1: its 40 bytes are not a depth image");
}

TEST_F(ViewsFile, ClaimsAreHeldAgainstItsSizeBeforeMemoryIsTaken) {
  for (const std::size_t at : {24, 32, 36}) {  // the counts of the header
    std::string hostile = bytes_;
    const std::uint32_t count = 2'000'000'000;
    std::memcpy(hostile.data() + at, &count, sizeof(count));
    write(path_, hostile);
    EXPECT_LT(allocated_by([&] { EXPECT_THROW(read_views(path_), std::runtime_error); }), 100'000U);
  }
}

TEST_F(ViewsFile, StaysWhenItCannotBeReplaced) {
  std::filesystem::create_directory(folder_ / "map.kseg.partial.views");
  EXPECT_THROW(write_views(views_, path_), std::runtime_error);
  EXPECT_EQ(contents(path_), bytes_);
}

}  // namespace
}  // namespace kintsugi::segmenter
