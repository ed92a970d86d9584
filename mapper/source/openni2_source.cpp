#include "mapper/source/openni2_source.hpp"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include <unistd.h>

#include "mapper/openni2_driver/calibration.hpp"
#include "mapper/source/oni_file.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxUri = 255;  // bytes, OpenNI2's own limit
constexpr auto kPoll = std::chrono::milliseconds(100);
constexpr auto kMaxSilence = std::chrono::seconds(10);

/// A file that is gone when this is.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string pattern = (fs::temp_directory_path() / "kintsugi-XXXXXX").string();
    const int descriptor = mkstemp(pattern.data());
    if (descriptor < 0) throw std::runtime_error(pattern + ": cannot be created");
    close(descriptor);
    path_ = pattern;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A path to a file, in contrast to the URI of a device.
bool names_a_file(const std::string& device) {
  if (device.empty() || device.find("://") != std::string::npos) return false;
  return fs::exists(device) || device.ends_with(".oni") || device.starts_with('/') ||
         device.starts_with('.');
}

std::unique_ptr<OpenNi2Device> open_uri(const std::string& uri, const SourceConfig& config) {
  if (uri.size() > kMaxUri) {
    throw std::runtime_error("'" + uri + "' is longer than the 255 bytes that OpenNI2 can open");
  }
  return std::make_unique<OpenNi2Device>(uri, config);
}

/// @param damage out: what is wrong with a .oni file, and how much of it is there.
std::unique_ptr<OpenNi2Device> open_device(const SourceConfig& config, std::string& damage) {
  if (!names_a_file(config.device)) return open_uri(config.device, config);
  const fs::path file = fs::absolute(config.device);
  if (fs::is_directory(file)) {
    throw std::runtime_error(file.string() +
                             ": is a folder; a recording in TUM layout is opened as folder://" +
                             file.string());
  }
  const OniFile contents = scan_oni_file(file);
  if (contents.damage.empty()) return open_uri(file.string(), config);

  const auto announced = contents.frames_announced(OniFile::Node::Kind::kDepth);
  damage = std::to_string(contents.frames(OniFile::Node::Kind::kDepth)) + " of " +
           (announced == 0 ? "an unknown number of" : std::to_string(announced)) +
           " depth images: " + file.string() + ": " + contents.damage;
  const TemporaryFile copy;
  write_mended_copy(file, contents, copy.path());
  return open_uri(copy.path().string(), config);
}

Intrinsics find_intrinsics(const SourceConfig& config, const OpenNi2Device& device) {
  const Intrinsics own = device.intrinsics();
  fs::path file = config.calibration_file;
  if (file.empty() && names_a_file(config.device)) {
    file = fs::absolute(config.device).parent_path() / "camera.txt";
    if (!fs::exists(file)) file.clear();
  }
  if (file.empty()) return own;
  const Intrinsics intrinsics = read_calibration(file).intrinsics;
  if (intrinsics.width != own.width || intrinsics.height != own.height) {
    throw std::runtime_error(file.string() + ": is for images of " +
                             std::to_string(intrinsics.width) + "x" +
                             std::to_string(intrinsics.height) + ", the device gives " +
                             std::to_string(own.width) + "x" + std::to_string(own.height));
  }
  return intrinsics;
}

}  // namespace

OpenNi2Source::OpenNi2Source(const SourceConfig& config)
    : config_(config),
      device_(open_device(config, damage_)),
      pairer_(device_->has_color()),
      last_image_(std::chrono::steady_clock::now()) {
  converter_.emplace(find_intrinsics(config, *device_), device_->depth_units_per_m(),
                     config.max_range_m);
  frames_total_ = device_->num_depth_frames().value_or(-1);
}

std::optional<RgbdFrame> OpenNi2Source::next() {
  for (;;) {
    if (const auto raw = pairer_.take()) {
      ++counts_.frames_delivered;
      return converter_->convert(*raw);
    }
    if (!end_reason_.empty()) return std::nullopt;
    read_image();
  }
}

SourceCounts OpenNi2Source::counts() const {
  SourceCounts counts = counts_;
  counts.depth_unpaired = pairer_.depth_unpaired();
  counts.color_unpaired = pairer_.color_unpaired();
  return counts;
}

void OpenNi2Source::read_image() {
  if (config_.stop_requested()) return end(true, "stopped on request");
  const OpenNi2Device::State state_before = device_->state();
  try {
    if (auto image = device_->wait(kPoll)) return add(std::move(*image));
  } catch (const std::runtime_error&) {
    ++counts_.frames_bad;
    last_image_ = std::chrono::steady_clock::now();
    return;
  }
  check_for_end(state_before);
}

void OpenNi2Source::add(DeviceImage image) {
  last_image_ = std::chrono::steady_clock::now();
  if (!image.is_depth) return pairer_.add_color(image.utime, std::move(image.color_rgb));
  if (last_depth_index_ > 0 && image.index > last_depth_index_ + 1) {
    counts_.frames_dropped += image.index - last_depth_index_ - 1;
  }
  last_depth_index_ = image.index;
  pairer_.add_depth(image.utime, image.index, std::move(image.depth_raw));
}

/// Nothing came. OpenNI2 itself only lets the wait time out when a recording is over.
/// @param state_before from before the wait: what the device had played by then has been read.
void OpenNi2Source::check_for_end(OpenNi2Device::State state_before) {
  if (state_before == OpenNi2Device::State::kFailed) return end(false, device_->failure());
  if (state_before == OpenNi2Device::State::kEnded) {
    if (!damage_.empty()) return end(false, "ended after " + damage_);
    return end(true, "end of the recording");
  }
  const auto silence = std::chrono::steady_clock::now() - last_image_;
  if (silence < kMaxSilence) return;
  end(false, "no image came for " +
                 std::to_string(std::chrono::duration_cast<std::chrono::seconds>(silence).count()) +
                 " s");
}

void OpenNi2Source::end(bool well, const std::string& reason) {
  ended_well_ = well;
  end_reason_ = reason;
  device_->stop();
  pairer_.finish();
}

}  // namespace kintsugi::mapper
