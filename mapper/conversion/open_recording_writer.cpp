#include <stdexcept>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/conversion/recording_writer.hpp"
#include "mapper/conversion/writers.hpp"

namespace kintsugi::mapper {

std::unique_ptr<RecordingWriter> open_recording_writer(const std::filesystem::path& path,
                                                       const WritingOptions& options) {
  check_range("jpeg_quality", options.jpeg_quality, 0, 100);
  if (std::filesystem::exists(path)) {
    throw std::runtime_error(path.string() + ": exists, and is not overwritten");
  }
  if (path.extension() == ".klg") return make_klg_writer(path, options);
  if (path.extension() == ".lcm") return make_frame_log_writer(path, options);
  return make_tum_writer(path.has_filename() ? path : path.parent_path());
}

}  // namespace kintsugi::mapper
