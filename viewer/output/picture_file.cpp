#include "viewer/output/picture_file.hpp"

#include <opencv2/imgcodecs.hpp>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::viewer {

void write_png(const std::filesystem::path& path, const cv::Mat3b& image) {
  // cv::imwrite does not report a full disk, so OpenCV only encodes.
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

std::vector<std::uint8_t> encode_jpeg(const cv::Mat3b& image, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

}  // namespace kintsugi::viewer
