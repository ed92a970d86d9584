#include "viewer/output/picture_folder.hpp"

#include <system_error>

#include "viewer/output/picture_file.hpp"

namespace kintsugi::viewer {

bool PictureFolder::save(const std::string& name, const cv::Mat3b& picture) {
  const bool is_written = attempts_([&] { write_png(folder_ / name, picture); });
  if (is_written) ++written_;
  return is_written;
}

void PictureFolder::remove(const std::string& name) {
  std::error_code ignored;  // a picture too many does no harm
  std::filesystem::remove(folder_ / name, ignored);
}

}  // namespace kintsugi::viewer
