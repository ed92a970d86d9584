#include "mapper/openni2_driver/formats/exr_image.hpp"

#include <array>
#include <exception>
#include <stdexcept>
#include <string>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

namespace kintsugi::mapper {
namespace {

/// Runs `read` on the opened file; what OpenEXR throws names no file.
template <typename Read>
auto with_file(const std::filesystem::path& file, Read read) {
  try {
    Imf::InputFile input(file.c_str());
    return read(input);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": cannot be read as OpenEXR: " + error.what());
  }
}

cv::Size size_of(const Imf::InputFile& input) {
  constexpr int kMaxSide = 4096;  // memory is taken by what the header says
  const Imath::Box2i& window = input.header().dataWindow();
  if (window.min != Imath::V2i(0, 0) || window.max.x < 0 || window.max.y < 0 ||
      window.max.x >= kMaxSide || window.max.y >= kMaxSide) {
    throw std::runtime_error("its window is not one from (0, 0) to at most 4096x4096 pixels");
  }
  return {window.max.x + 1, window.max.y + 1};
}

const char* depth_channel(const Imf::ChannelList& channels) {
  for (const char* name : {"Z", "Y", "R"}) {
    const Imf::Channel* channel = channels.findChannel(name);
    if (channel != nullptr && channel->xSampling == 1 && channel->ySampling == 1) return name;
  }
  throw std::runtime_error("it has none of the channels Z, Y and R");
}

}  // namespace

cv::Size exr_size(const std::filesystem::path& file) { return with_file(file, size_of); }

cv::Mat_<float> decode_exr(const std::filesystem::path& file, cv::Size expected) {
  return with_file(file, [&](Imf::InputFile& input) {
    const cv::Size size = size_of(input);
    if (size != expected) {
      throw std::runtime_error(
          "it is " + std::to_string(size.width) + "x" + std::to_string(size.height) +
          ", expected " + std::to_string(expected.width) + "x" + std::to_string(expected.height));
    }
    cv::Mat_<float> image(size, 0.0F);
    Imf::FrameBuffer buffer;
    buffer.insert(
        depth_channel(input.header().channels()),
        Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.data), sizeof(float), image.step[0]));
    input.setFrameBuffer(buffer);
    input.readPixels(0, size.height - 1);
    return image;
  });
}

}  // namespace kintsugi::mapper
