// Recordings of OpenNI2 itself, whole and spoilt.

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/openni2_driver/formats/image_decoder.hpp"
#include "mapper/source/open_source.hpp"
#include "mapper/source/openni2/oni_file.hpp"
#include "tests/mapper/source/oni_recording.hpp"
#include "tests/support/allocation_limit.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::kNumFrames;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = OniFile::Node::Kind;

class RecordedOni : public ::testing::Test {
 protected:
  void SetUp() override {
    test::record_oni(folder_, file_);
    bytes_ = read_bytes(file_);
    bytes_.resize(scan_oni_file(file_).good_bytes);  // the recorder leaves rubbish after its end
  }

  /// Only the first `size` bytes.
  fs::path cut(std::size_t size) {
    fs::path file = folder_.path() / "cut.oni";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(size));
    return file;
  }

  static std::unique_ptr<FrameSource> open(const fs::path& file) {
    SourceConfig config;
    config.device = file.string();
    config.assume_registered = true;
    return open_frame_source(config);
  }

  test::RecordingFolder folder_;
  fs::path file_ = folder_.path() / "recorded.oni";
  std::vector<std::uint8_t> bytes_;
};

TEST_F(RecordedOni, PlaysBackFrameForFrame) {
  const auto source = open(file_);
  EXPECT_EQ(source->status().frames_total, kNumFrames);
  for (int i = 0; i < kNumFrames; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame) << source->status().end_reason;
    EXPECT_EQ(frame->utime, 33333 * i) << "from 0, as OpenNI2 records";
    const cv::Mat_<std::uint16_t> raw = test::raw_depth_image(i);
    for (int y = 0; y < raw.rows; ++y) {
      for (int x = 0; x < raw.cols; ++x) {
        if (raw(y, x) == 0) {
          ASSERT_TRUE(std::isnan(frame->depth_m(y, x)));
        } else {
          ASSERT_EQ(frame->depth_m(y, x), static_cast<float>(raw(y, x) * 0.001));
        }
      }
    }
    EXPECT_EQ(cv::norm(frame->color_rgb, test::color_image(i), cv::NORM_INF), 0.0);
  }
  EXPECT_FALSE(source->next());
  EXPECT_TRUE(source->status().ended_well);
  EXPECT_EQ(source->status().end_reason, "end of the recording");
  EXPECT_EQ(source->status().counts.frames_dropped, 0);
}

TEST_F(RecordedOni, GivesDepthAloneUnlessItIsTakenForRegistered) {
  std::vector<std::string> warnings;
  SourceConfig config;
  config.device = file_.string();
  config.notify = [&](const SourceNotice& notice) { warnings.push_back(notice.text); };
  const auto frame = open_frame_source(config)->next();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->color_rgb.empty());
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("--assume-registered")));
}

TEST_F(RecordedOni, IsScannedByItsRecords) {
  const OniFile contents = scan_oni_file(file_);
  EXPECT_EQ(contents.frames(Kind::kDepth), kNumFrames);
  EXPECT_EQ(contents.frames(Kind::kColor), kNumFrames);
  EXPECT_EQ(contents.frames_announced(Kind::kDepth), kNumFrames);
  EXPECT_EQ(contents.damage, "");
}

TEST_F(RecordedOni, IsReadUpToWhereItIsCutOff) {
  const auto source = open(cut(bytes_.size() / 2));
  int frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(cv::norm(frame->color_rgb, test::color_image(frames), cv::NORM_INF), 0.0);
    ++frames;
  }
  EXPECT_GT(frames, 0);
  EXPECT_LT(frames, kNumFrames);
  EXPECT_EQ(source->status().frames_total, frames);
  EXPECT_FALSE(source->status().ended_well);
  EXPECT_THAT(source->status().end_reason,
              AllOf(HasSubstr("ended after " + std::to_string(frames) + " of 5 depth images"),
                    HasSubstr("cut.oni: it is cut off at byte")));
}

TEST_F(RecordedOni, OfARecorderThatWasKilledIsReadToo) {
  // Until it is destroyed, the recorder leaves the number of streams, the numbers of frames, the
  // seek tables and the end record unwritten.
  const OniFile whole = scan_oni_file(file_);
  std::fill_n(bytes_.begin() + 20, 4, std::uint8_t{0});
  for (const auto& [id, node] : whole.nodes) {
    const auto fields = bytes_.begin() + static_cast<std::ptrdiff_t>(node.fields_position);
    std::fill_n(fields, 4, std::uint8_t{0xFF});
    std::fill_n(fields + 20, 8, std::uint8_t{0});
  }
  const auto source = open(cut(bytes_.size() - 28));  // no end record
  int frames = 0;
  while (source->next()) ++frames;
  EXPECT_EQ(frames, kNumFrames);
  EXPECT_FALSE(source->status().ended_well);
  EXPECT_THAT(source->status().end_reason,
              AllOf(HasSubstr("5 of an unknown number of depth images"),
                    HasSubstr("ends without an end record")));
}

TEST_F(RecordedOni, CutOffAnywhereIsScannedOrRefused) {
  const std::size_t step = bytes_.size() / 97;
  for (std::size_t size = 0; size < bytes_.size(); size += size < 200 ? 7 : step) {
    const fs::path file = cut(size);
    try {
      const OniFile contents = scan_oni_file(file);
      EXPECT_NE(contents.damage, "") << size;
      EXPECT_LE(contents.good_bytes, size);
      EXPECT_GT(contents.frames(Kind::kDepth), 0);
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("cut.oni: ")) << size;
    }
  }
}

TEST_F(RecordedOni, WithAByteOfItsHeadersChangedIsScannedOrRefused) {
  for (std::size_t i = 0; i < std::min<std::size_t>(bytes_.size(), 1500); i += 3) {
    const std::uint8_t right = bytes_[i];
    for (const std::uint8_t wrong : {0x00, 0x7F, 0xFF}) {
      bytes_[i] = wrong;
      const fs::path file = cut(bytes_.size());
      try {
        const OniFile contents = scan_oni_file(file);
        EXPECT_LE(contents.good_bytes, bytes_.size());
      } catch (const std::runtime_error&) {
      }
    }
    bytes_[i] = right;
  }
}

TEST(OniFile, TakesNoMemoryForARecordThatCannotBeThere) {
  const test::RecordingFolder folder;
  const fs::path file = folder.path() / "bad.oni";
  std::string bytes("NI10\x01\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\x02\0\0\0", 24);
  bytes += std::string("NIR\0\x0D\0\0\0\x01\0\0\0", 12);  // a stream is announced
  bytes += std::string("\0\0\x09\0\xff\xff\xff\x7f", 8);  // in 576 kB, with 2 GB behind
  test::write_text(file, bytes + std::string(8, '\0'));
  const auto refuse = [&] {
    EXPECT_THAT(error_of<std::runtime_error>([&] { scan_oni_file(file); }), HasSubstr("cut off"));
  };
  EXPECT_LT(kintsugi::testing::allocated_by(refuse), 32'768U);  // the stream's buffer, the reason
}

TEST(OniFile, SaysWhatIsWrong) {
  const test::RecordingFolder folder;
  const fs::path file = folder.path() / "bad.oni";
  const auto error = [&] { return error_of<std::runtime_error>([&] { scan_oni_file(file); }); };
  EXPECT_THAT(error(), HasSubstr("bad.oni: no such file"));
  test::write_text(file, "");
  EXPECT_THAT(error(), HasSubstr("bad.oni: is empty"));
  test::write_text(file, "RIFF....AVI LIST, a foreign file");
  EXPECT_THAT(error(), HasSubstr("does not begin with NI10"));
  test::write_text(file, "NI10\x01");
  EXPECT_THAT(error(), HasSubstr("cut off in its header"));
  test::write_text(file, std::string("NI10\x02\0\0\0\0\0\0\0............", 24));
  EXPECT_THAT(error(), HasSubstr("is of version 2.0.0"));
  test::write_text(file,
                   std::string("NI10\x01\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\xff\xff\xff\xff", 24));
  EXPECT_THAT(error(), HasSubstr("announces 4294967295 streams"));
  test::write_text(file, std::string("NI10\x01\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\x02\0\0\0", 24));
  EXPECT_THAT(error(), HasSubstr("holds no depth image"));
}

}  // namespace
}  // namespace kintsugi::mapper
