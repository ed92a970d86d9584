// Compressed images: what a file claims is checked before memory is taken for it.

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "mapper/openni2_driver/formats/image_decoder.hpp"
#include "mapper/openni2_driver/formats/image_header.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// Counts the pixels' memory while it is there. OpenCV does not take it with operator new.
class CountingAllocator : public cv::MatAllocator {
 public:
  CountingAllocator() { cv::Mat::setDefaultAllocator(this); }
  ~CountingAllocator() override { cv::Mat::setDefaultAllocator(cv::Mat::getStdAllocator()); }
  CountingAllocator(const CountingAllocator&) = delete;
  CountingAllocator& operator=(const CountingAllocator&) = delete;

  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    std::size_t count = data == nullptr ? CV_ELEM_SIZE(type) : 0;
    for (int i = 0; i < dims; ++i) count *= static_cast<std::size_t>(sizes[i]);
    bytes_ += count;
    return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override {
    cv::Mat::getStdAllocator()->deallocate(data);
  }
  std::size_t bytes() const { return bytes_; }

 private:
  mutable std::size_t bytes_ = 0;
};

Bytes encoded(const char* extension, const cv::Mat& image) {
  Bytes bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

cv::Mat_<std::uint16_t> depth_image() { return cv::Mat_<std::uint16_t>(6, 8, 1'234); }
cv::Mat_<cv::Vec3b> color_image() { return cv::Mat_<cv::Vec3b>(6, 8, cv::Vec3b(10, 200, 90)); }

std::string refusal(const std::function<void()>& decode) {
  try {
    decode();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

void write_big_endian(std::uint32_t value, int num_bytes, std::uint8_t* place) {
  for (int i = num_bytes - 1; i >= 0; --i, value >>= 8U) {
    place[i] = static_cast<std::uint8_t>(value);
  }
}

TEST(ImageHeader, TellsSizeAndBitsOfWhatOpenCvWrites) {
  const auto depth = read_image_header(encoded(".png", depth_image()));
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->size, cv::Size(8, 6));
  EXPECT_EQ(depth->bits_per_pixel, 16);
  for (const char* extension : {".png", ".jpg"}) {
    const auto color = read_image_header(encoded(extension, color_image()));
    ASSERT_TRUE(color) << extension;
    EXPECT_EQ(color->size, cv::Size(8, 6)) << extension;
    EXPECT_EQ(color->bits_per_pixel, 24) << extension;
  }
}

TEST(ImageHeader, IsNothingWhereThereIsNone) {
  for (const char* extension : {".png", ".jpg"}) {
    const Bytes whole = encoded(extension, color_image());
    const auto header = read_image_header(whole);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto cut = read_image_header(std::span(whole).first(size));
      EXPECT_TRUE(!cut || cut->size == header->size) << extension << " cut to " << size;
    }
  }
  EXPECT_FALSE(read_image_header(encoded(".bmp", color_image())));
}

TEST(ImageDecoder, TakesNoMemoryForPixelsThatCannotBeThere) {
  Bytes png = encoded(".png", depth_image());
  write_big_endian(16'384, 4, &png[16]);  // width, height
  write_big_endian(16'384, 4, &png[20]);
  Bytes jpeg = encoded(".jpg", color_image());
  const Bytes frame = {0xFF, 0xC0, 0, 17, 8};  // the segment that tells height and width
  const auto found = std::search(jpeg.begin(), jpeg.end(), frame.begin(), frame.end());
  ASSERT_NE(found, jpeg.end());
  write_big_endian(16'384, 2, &*found + 5);
  write_big_endian(16'384, 2, &*found + 7);

  const CountingAllocator memory;
  EXPECT_THAT(refusal([&] {
                (void)decode_depth(png, {16'384, 16'384}, "a.png");
              }),
              HasSubstr("a.png: is cut off"));
  EXPECT_THAT(refusal([&] {
                (void)decode_color(jpeg, {16'384, 16'384}, "a.jpg");
              }),
              HasSubstr("a.jpg: is cut off"));
  EXPECT_THAT(refusal([&] {
                (void)decode_depth(png, {8, 6}, "a.png");
              }),
              HasSubstr("a.png: is 16384x16384, expected 8x6"));
  EXPECT_EQ(memory.bytes(), 0U);
}

TEST(ImageDecoder, ReadsImagesThatCompressBest) {
  const cv::Mat_<std::uint16_t> depth(2'160, 3'840, std::uint16_t{0});
  EXPECT_EQ(cv::countNonZero(decode_depth(encoded(".png", depth), depth.size(), "depth")), 0);
  const cv::Mat_<cv::Vec3b> color(2'160, 3'840, cv::Vec3b(0, 0, 0));
  for (const char* extension : {".png", ".jpg"}) {
    EXPECT_EQ(decode_color(encoded(extension, color), color.size(), "color").size(), color.size());
  }
}

TEST(ImageDecoder, ReadsNothingButPngAndJpeg) {
  EXPECT_THAT(refusal([] {
                (void)decode_color(encoded(".bmp", color_image()), {8, 6}, "a.bmp");
              }),
              HasSubstr("expected PNG or JPEG"));
}

}  // namespace
}  // namespace kintsugi::mapper
