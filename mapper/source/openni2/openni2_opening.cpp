#include "mapper/source/openni2/openni2_opening.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include <unistd.h>

#include "mapper/openni2_driver/formats/calibration.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/source/openni2/oni_file.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxUri = 255;  // bytes, OpenNI2's own limit

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

std::unique_ptr<OpenNi2Device> open_uri(const std::string& uri, const SourceConfig& config) {
  if (uri.size() > kMaxUri) {
    throw std::runtime_error("'" + uri + "' is longer than the 255 bytes that OpenNI2 can open");
  }
  return std::make_unique<OpenNi2Device>(uri, config);
}

}  // namespace

bool names_a_file(const std::string& device) {
  if (device.empty() || device.find("://") != std::string::npos) return false;
  const fs::path extension = fs::path(device).extension();
  const bool is_named_like_one =
      std::ranges::any_of(std::array{".oni", ".klg", ".sens", ".bag"},
                          [&](const char* one) { return extension == one; });
  return fs::exists(device) || is_named_like_one || device.starts_with('/') ||
         device.starts_with('.');
}

std::string driver_address(const std::string& device) {
  if (!names_a_file(device) || is_oni_file(device)) return device;
  return recording_address(fs::absolute(device));
}

std::unique_ptr<OpenNi2Device> open_device(const SourceConfig& config, std::string& damage) {
  if (!names_a_file(config.device)) return open_uri(config.device, config);
  const fs::path file = fs::absolute(config.device);
  if (!is_oni_file(file)) return open_uri(driver_address(config.device), config);
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
  fs::path file = config.calibration_file;
  // Every other recording tells its own.
  if (file.empty() && names_a_file(config.device) && is_oni_file(config.device)) {
    file = fs::absolute(config.device).parent_path() / "camera.txt";
    if (!fs::exists(file)) file.clear();
  }
  if (file.empty()) return device.intrinsics();
  const cv::Size own = device.image_size();
  const Intrinsics intrinsics = read_calibration(file).intrinsics;
  if (intrinsics.width != own.width || intrinsics.height != own.height) {
    throw std::runtime_error(file.string() + ": is for images of " +
                             std::to_string(intrinsics.width) + "x" +
                             std::to_string(intrinsics.height) + ", the device gives " +
                             std::to_string(own.width) + "x" + std::to_string(own.height));
  }
  return intrinsics;
}

}  // namespace kintsugi::mapper
