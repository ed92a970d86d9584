#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/formats/folder_name.hpp"
#include "mapper/openni2_driver/formats/frame_numbers.hpp"
#include "mapper/openni2_driver/formats/image_files.hpp"
#include "mapper/openni2_driver/formats/image_list.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

struct KnownCamera {
  std::array<std::string_view, 2> names;  ///< one of them is in the name of the folder
  const char* remark;
  Calibration calibration;
};

constexpr double kTumUnits_per_m = 5000.0;

Calibration calibration_of(double fx, double fy, double cx, double cy,
                           std::array<double, 5> distortion = {}) {
  return {.intrinsics = {.fx = fx,
                         .fy = fy,
                         .cx = cx,
                         .cy = cy,
                         .width = 640,
                         .height = 480,
                         .distortion = distortion},
          .depth_units_per_m = kTumUnits_per_m};
}

/// The colour cameras as the benchmark publishes them; its depth images are registered to colour.
std::array<KnownCamera, 3> tum_cameras() {
  return {{{{"freiburg1", "fr1"},
            "the camera is that of freiburg1, as the TUM benchmark publishes it",
            calibration_of(517.306408, 516.469215, 318.643040, 255.313989,
                           {0.262383, -0.953104, -0.005358, 0.002628, 1.163314})},
           {{"freiburg2", "fr2"},
            "the camera is that of freiburg2, as the TUM benchmark publishes it",
            calibration_of(520.908620, 521.007327, 325.141442, 249.701764,
                           {0.231222, -0.784899, -0.003257, -0.000105, 0.917205})},
           {{"freiburg3", "fr3"},
            "the camera is that of freiburg3, as the TUM benchmark publishes it",
            calibration_of(535.4, 539.2, 320.1, 247.6)}}};
}

Calibration find_calibration(const fs::path& folder, bool has_frame_numbers,
                             std::vector<std::string>& remarks) {
  if (auto own = own_calibration(folder)) return *std::move(own);
  if (has_frame_numbers) {
    remarks.emplace_back("the camera is that of ICL-NUIM, whose lists have frame numbers");
    return calibration_of(481.2, -480.0, 319.5, 239.5);
  }
  const std::string name = name_of(folder);
  for (const KnownCamera& camera : tum_cameras()) {
    const bool is_named = std::ranges::any_of(
        camera.names, [&](std::string_view part) { return name.find(part) != std::string::npos; });
    if (!is_named) continue;
    remarks.emplace_back(camera.remark);
    return camera.calibration;
  }
  throw std::runtime_error(
      folder.string() +
      ": has no camera.txt, and its name does not say which camera of the TUM benchmark it is "
      "from (freiburg1, freiburg2, freiburg3); write a camera.txt of one line: fx fy cx cy width "
      "height depth_scale [k1 k2 p1 p2 k3]");
}

}  // namespace

bool is_tum_folder(const fs::path& folder) {
  return fs::exists(folder / "depth.txt") || fs::exists(folder / "associations.txt");
}

RecordingContents read_tum_folder(const fs::path& folder) {
  ImageLists lists = read_image_lists(folder);
  RecordingContents contents;
  const bool numbers = has_frame_numbers(lists);
  if (numbers) {
    replace_frame_numbers(lists);
    contents.remarks.push_back(
        "the times of the images are frame numbers, not seconds: mapped at " +
        std::to_string(kNumberedFrames_Hz) + " frames a second");
  }
  contents.format = "folder in the layout of the TUM RGB-D benchmark";
  contents.name = name_of(folder);
  contents.calibration = find_calibration(folder, numbers, contents.remarks);
  ImageFiles::Files files;
  const auto split = [](std::vector<TimedImage>& images, std::vector<std::int64_t>& utimes,
                        std::vector<fs::path>& paths) {
    utimes.reserve(images.size());
    paths.reserve(images.size());
    for (TimedImage& image : images) {
      utimes.push_back(image.utime);
      paths.push_back(std::move(image.file));
    }
  };
  split(lists.depth, contents.depth_utimes, files.depth);
  split(lists.color, contents.color_utimes, files.color);
  const Intrinsics& camera = contents.calibration.intrinsics;
  const cv::Size size(camera.width, camera.height);
  contents.images = std::make_unique<ImageFiles>(std::move(files), size, size);
  return contents;
}

}  // namespace kintsugi::mapper
