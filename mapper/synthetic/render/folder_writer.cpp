#include "mapper/synthetic/render/folder_writer.hpp"

#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "mapper/synthetic/render/ground_truth.hpp"

namespace kintsugi::synthetic {

namespace {

std::string seconds(std::int64_t utime) {
  char text[32];
  std::snprintf(text, sizeof(text), "%lld.%06lld", static_cast<long long>(utime / 1'000'000),
                static_cast<long long>(utime % 1'000'000));
  return text;
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  constexpr int kFast = 1;
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, kFast});
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

/// For imwrite's blue, green, red.
cv::Mat_<cv::Vec3b> normal_picture(const RenderedFrame& frame) {
  cv::Mat_<cv::Vec3b> picture(frame.normals_W.size(), cv::Vec3b(0, 0, 0));
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      if (frame.instances(v, u) == kNoInstance) continue;
      const cv::Vec3f n = frame.normals_W(v, u);
      for (int axis = 0; axis < 3; ++axis) {
        picture(v, u)[2 - axis] = cv::saturate_cast<std::uint8_t>(127.5F * (1.0F + n[axis]));
      }
    }
  }
  return picture;
}

}  // namespace

FrameRange FrameRange::parse(const std::string& text, int count) {
  FrameRange range{0, count, 1};
  int* const fields[] = {&range.first, &range.end, &range.step};
  const auto fail = [&](const char* expected) {
    throw std::invalid_argument("frames '" + text + "': expected " + expected + " within 0 to " +
                                std::to_string(count));
  };
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int* field : fields) {
    if (at == end) break;
    if (*at != ':') {
      const auto [stopped, error] = std::from_chars(at, end, *field);
      if (error != std::errc()) fail("first:end:step");
      at = stopped;
    }
    if (at == end) break;
    if (*at != ':') fail("first:end:step");
    ++at;
  }
  if (at != end) fail("first:end:step");
  if (range.first < 0 || range.end > count || range.first >= range.end || range.step < 1) {
    fail("first < end and step >= 1");
  }
  return range;
}

FolderWriter::FolderWriter(Sequence& sequence, std::filesystem::path folder)
    : sequence_(sequence), folder_(std::move(folder)) {
  for (const char* name : {"depth", "rgb", "normals", "instances"}) {
    std::filesystem::create_directories(folder_ / name);
  }
}

void FolderWriter::write_frame(int frame) {
  const std::string time = seconds(sequence_.utime(frame));
  const RenderedFrame& truth = sequence_.truth(frame);
  cv::Mat color_bgr;
  cv::cvtColor(sequence_.color_rgb(frame), color_bgr, cv::COLOR_RGB2BGR);
  write_png(folder_ / "depth" / (time + ".png"), sequence_.depth_mm(frame));
  write_png(folder_ / "rgb" / (time + ".png"), color_bgr);
  write_png(folder_ / "normals" / (time + ".png"), normal_picture(truth));
  write_png(folder_ / "instances" / (time + ".png"), truth.instances);
  seconds_.push_back(time);
}

void FolderWriter::finish() {
  AtomicFile depth(folder_ / "depth.txt");
  AtomicFile rgb(folder_ / "rgb.txt");
  AtomicFile associations(folder_ / "associations.txt");
  for (const std::string& time : seconds_) {
    depth.stream() << time << " depth/" << time << ".png\n";
    rgb.stream() << time << " rgb/" << time << ".png\n";
    associations.stream() << time << " depth/" << time << ".png " << time << " rgb/" << time
                          << ".png\n";
  }
  write_ground_truth(sequence_, folder_);
  depth.commit();
  rgb.commit();
  associations.commit();
}

}  // namespace kintsugi::synthetic
