#include "mapper/source/probe.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/source/openni2/oni_file.hpp"
#include "mapper/source/openni2/openni2_opening.hpp"

namespace kintsugi::mapper {
namespace {

/// One line of the answer; several with the same name have it once.
class Lines {
 public:
  template <typename... Values>
  void add(const char* name, const char* format, Values... values) {
    std::array<char, 1024> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    add(name, std::string(text.data()));
  }

  void add(const char* name, const std::string& text) {
    std::string title = name == last_ ? "" : name;
    last_ = name;
    title.resize(14, ' ');
    text_ += "  " + title + text + "\n";
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string last_;
  std::string text_;
};

std::string text_of(const Intrinsics& camera) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), "%dx%d pixels, fx %g fy %g cx %g cy %g%s", camera.width,
                camera.height, camera.fx, camera.fy, camera.cx, camera.cy,
                camera.fy < 0.0 ? ", y up" : "");
  std::string result = text.data();
  const bool is_distorted =
      std::ranges::any_of(camera.distortion, [](double term) { return term != 0.0; });
  if (!is_distorted) return result + ", no distortion";
  result += ", distortion";
  for (const double term : camera.distortion) {
    std::snprintf(text.data(), text.size(), " %g", term);
    result += text.data();
  }
  return result;
}

/// Reads the first, the middle and the last image, and asks of the others whether they are there.
void add_missing(Lines& lines, const char* what, int num_images,
                 const std::function<bool(int)>& is_missing, const std::function<void(int)>& read) {
  int num_missing = 0;
  for (int i = 0; i < num_images; ++i) num_missing += is_missing(i) ? 1 : 0;
  if (num_missing > 0) {
    lines.add("missing", "%d of %d %s images: they are passed over", num_missing, num_images, what);
  }
  for (const int i : std::set<int>{0, num_images / 2, num_images - 1}) {
    if (i < 0 || i >= num_images || is_missing(i)) continue;
    try {
      read(i);
    } catch (const std::runtime_error& error) {
      lines.add("missing", std::string(what) + ": " + error.what());
    }
  }
}

void describe_recording(Lines& lines, FileRecording& recording) {
  const RecordingContents& contents = recording.contents();
  lines.add("format", contents.format);
  const int num_depth = recording.num_depth_frames();
  const int num_color = recording.num_color_frames();
  const double length_s =
      1e-6 * static_cast<double>(contents.depth_utimes.back() - contents.depth_utimes.front());
  lines.add("length", "%.2f s, %d depth images, %d colour images, %d frames a second", length_s,
            num_depth, num_color, recording.frame_rate_hz());
  lines.add("depth camera", text_of(recording.intrinsics()));
  lines.add("depth unit", "%g a metre", contents.calibration.depth_units_per_m);
  if (num_color == 0) {
    lines.add("colour camera", std::string("none: there is no colour"));
  } else if (!contents.color_camera) {
    lines.add("colour camera", std::string("the same pixels as depth"));
  } else {
    lines.add("colour camera", text_of(contents.color_camera->intrinsics));
    lines.add("", "%.1f mm from the depth camera",
              1e3 * contents.color_camera->X_RC.translation().norm());
  }
  const auto num_poses = std::ranges::count_if(
      contents.depth_X_WC, [](const std::optional<Pose>& X_WC) { return X_WC.has_value(); });
  if (num_poses > 0) lines.add("poses", "of %d depth images", static_cast<int>(num_poses));
  for (const std::string& remark : contents.remarks) lines.add("note", remark);
  ImageStore& images = *contents.images;
  add_missing(
      lines, "depth", num_depth, [&](int i) { return images.depth_is_missing(i); },
      [&](int i) { (void)images.depth(i); });
  add_missing(
      lines, "colour", num_color, [&](int i) { return images.color_is_missing(i); },
      [&](int i) { (void)images.color(i); });
}

void describe_oni(Lines& lines, const std::filesystem::path& file) {
  const OniFile contents = scan_oni_file(file);
  lines.add("format", std::string("recording of OpenNI2 (.oni)"));
  lines.add("length", "%d depth images, %d colour images",
            contents.frames(OniFile::Node::Kind::kDepth),
            contents.frames(OniFile::Node::Kind::kColor));
  lines.add("depth camera",
            std::filesystem::exists(file.parent_path() / "camera.txt")
                ? std::string("camera.txt beside it")
                : std::string("only its field of view; --calibration makes the map accurate"));
  if (!contents.damage.empty()) lines.add("missing", "the rest: " + contents.damage);
}

}  // namespace

std::string probe_recording(const std::string& device) {
  Lines lines;
  if (names_a_file(device) && is_oni_file(device)) {
    describe_oni(lines, std::filesystem::absolute(device));
    return device + "\n" + lines.text();
  }
  const auto uri = parse_recording_uri(driver_address(device));
  if (!uri) {
    throw std::invalid_argument("'" + device +
                                "' is no recording: expected a path or recording://PATH");
  }
  const auto recording = open_recording(*uri);
  if (auto* file = dynamic_cast<FileRecording*>(recording.get())) {
    describe_recording(lines, *file);
  } else {
    lines.add("format", std::string("synthetic scene"));
    lines.add("length", "%d frames, %d a second", recording->num_depth_frames(),
              recording->frame_rate_hz());
    lines.add("depth camera", text_of(recording->intrinsics()));
  }
  return device + "\n" + lines.text();
}

}  // namespace kintsugi::mapper
