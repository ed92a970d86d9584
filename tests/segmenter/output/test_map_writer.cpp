#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/io/saved_map.hpp"
#include "segmenter/output/map_writer.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MapWriterTest : public ::testing::Test {
 protected:
  void add_slice() { map_.add({&slices_.at(map_.cloud().slices().size()), 1}); }
  std::size_t num_saved() const { return read_map_state(file_).slices.size(); }

  kintsugi::testing::TemporaryFolder folder_;
  std::vector<CloudSlice> slices_ = testing::wavy_session(3, 50);
  SegmentMap map_{{}, 1, slices_[0]};
  std::filesystem::path folder_of_file_ = folder_ / "saved";
  std::filesystem::path file_ = folder_of_file_ / "map.kseg";
  MapWriter writer_{{folder_.path(), file_}};
};

TEST_F(MapWriterTest, WritesWhatItIsTold) {
  add_slice();
  writer_.write(map_, "segments_5");
  writer_.wait();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "segments_5.ply"));
  EXPECT_FALSE(std::filesystem::exists(file_));
  writer_.save(map_);
  writer_.wait();
  EXPECT_EQ(num_saved(), 1U);
  add_slice();
  writer_.write_and_save(map_, "segments");
  writer_.wait();
  EXPECT_EQ(num_saved(), 2U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "segments.ply"));
  EXPECT_THAT(writer_.problem(), IsEmpty());
}

TEST_F(MapWriterTest, KeepsWhatCouldNotBeWrittenForAnotherTry) {
  std::ofstream(folder_of_file_) << "a file where the folder should be";
  add_slice();
  writer_.save(map_);
  writer_.wait();
  EXPECT_THAT(writer_.problem(), HasSubstr("the map is not written"));
  writer_.try_again();
  writer_.wait();
  EXPECT_THAT(writer_.problem(), HasSubstr("saved"));
  std::filesystem::remove(folder_of_file_);
  add_slice();  // what is kept is a copy
  writer_.try_again();
  writer_.wait();
  EXPECT_THAT(writer_.problem(), IsEmpty());
  EXPECT_EQ(num_saved(), 1U);
  writer_.try_again();  // nothing is left to do
  writer_.wait();
  EXPECT_EQ(num_saved(), 1U);
}

TEST_F(MapWriterTest, ANewerCopyTakesThePlaceOfOneThatCouldNotBeWritten) {
  std::ofstream(folder_of_file_) << "a file where the folder should be";
  add_slice();
  writer_.save(map_);
  writer_.wait();
  std::filesystem::remove(folder_of_file_);
  add_slice();
  writer_.save(map_);
  writer_.wait();
  EXPECT_THAT(writer_.problem(), IsEmpty());
  writer_.try_again();
  writer_.wait();
  EXPECT_EQ(num_saved(), 2U);
}

class MapWriterWithParts : public ::testing::Test {
 protected:
  MapWriterWithParts() { map_.add(slices_); }
  void join() {
    const CloudSlice correction = testing::correction_that_joins();
    map_.add({&correction, 1});
  }
  void write(const std::string& stem = "segments") {
    writer_.write(map_, stem);
    writer_.wait();
  }
  bool exists(const char* name) const { return std::filesystem::exists(folder_ / name); }

  kintsugi::testing::TemporaryFolder folder_;
  std::vector<CloudSlice> slices_ = testing::session_in_two_parts();
  SegmentMap map_{{}, 1, slices_[0]};
  MapWriter writer_{{folder_.path(), {}}};
};

TEST_F(MapWriterWithParts, LeavesNoFilesOfAPartThatHasBeenJoined) {
  write();
  EXPECT_TRUE(exists("segments.part1.ply"));
  std::ofstream(folder_ / "segments.part2.ply") << "of another run";
  std::ofstream(folder_ / "segments_5.part1.ply") << "of another map";
  join();
  write();
  EXPECT_TRUE(exists("segments.ply"));
  EXPECT_FALSE(exists("segments.part1.ply"));
  EXPECT_FALSE(exists("segments.part1.json"));
  EXPECT_FALSE(exists("segments.part1.csv"));
  EXPECT_TRUE(exists("segments.part2.ply"));
  EXPECT_TRUE(exists("segments_5.part1.ply"));
}

TEST_F(MapWriterWithParts, TouchesNothingThatItHasNotWritten) {
  std::ofstream(folder_ / "segments.part1.ply") << "of another run";
  join();
  write();
  EXPECT_TRUE(exists("segments.part1.ply"));
}

TEST_F(MapWriterWithParts, RemovesWhatWasHalfWrittenOfAPart) {
  std::filesystem::create_directory(folder_ / "segments.part1.json");  // cannot be replaced
  write();
  EXPECT_THAT(writer_.problem(), HasSubstr("segments.part1"));
  EXPECT_TRUE(exists("segments.part1.ply"));
  std::filesystem::remove(folder_ / "segments.part1.json");
  join();
  write();
  EXPECT_THAT(writer_.problem(), IsEmpty());
  EXPECT_FALSE(exists("segments.part1.ply"));
}

}  // namespace
}  // namespace kintsugi::segmenter
