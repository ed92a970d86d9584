#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "mapper/openni2_driver/formats/binary_file.hpp"
#include "mapper/openni2_driver/formats/file_formats.hpp"
#include "mapper/openni2_driver/formats/ros_bag_index.hpp"
#include "mapper/openni2_driver/formats/ros_images.hpp"
#include "mapper/openni2_driver/formats/ros_topics.hpp"
#include "mapper/openni2_driver/formats/ros_transforms.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using ros1::CameraTopics;

constexpr double kMillimetres_per_m = 1000.0;
constexpr double kFinestUnits_per_m = 10000.0;  // of metres in floating point, on the driver's side

std::int64_t utime_of(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec() / 1000U);
}

/// The images of one topic.
class ImageTopic {
 public:
  struct Info {
    std::int64_t utime = 0;
    std::int64_t recorded_utime = 0;
    std::string frame;  ///< of coordinates
    cv::Size size;      ///< 0x0 of a compressed image
    bool is_metric = false;
  };

  ImageTopic(const rosbag::Bag& bag, std::string name) : name_(std::move(name)) {
    if (name_.empty()) return;
    view_ = std::make_unique<rosbag::View>(bag, rosbag::TopicQuery(name_));
    std::vector<Info> infos;
    for (const rosbag::MessageInstance& message : *view_) {
      infos.push_back(info_of(message));
      infos.back().recorded_utime = utime_of(message.getTime());
      if (infos.back().is_metric != infos.front().is_metric) {
        throw std::runtime_error(
            name_ + ": image " + std::to_string(infos.size() - 1) +
            " is in metres and others are not, or the other way round; expected one "
            "encoding");
      }
      messages_.push_back(message);
    }
    if (infos.empty()) return;
    first_ = infos.front();
    // Not all drivers fill in the times of headers, and a clock may be set back for good.
    takes_recorded_times_ = 2 * num_without_time(infos) > infos.size();
    keep_ascending(infos, takes_recorded_times_ ? &Info::recorded_utime : &Info::utime);
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<std::int64_t>& utimes() const { return utimes_; }
  [[nodiscard]] const Info& first() const { return first_; }

  void tell_what_is_left_out(std::vector<std::string>& remarks) const {
    if (takes_recorded_times_) {
      remarks.push_back("the headers of " + name_ +
                        " have no times that ascend: those at which the bag has recorded it are "
                        "taken");
    }
    if (num_left_out_ == 0) return;
    remarks.push_back(std::to_string(num_left_out_) + " of " +
                      std::to_string(num_left_out_ + std::ssize(utimes_)) + " images of " + name_ +
                      " are left out, because their times are not after those before");
  }

  /// Calls `use` with the message, whichever of the two types it has, and with what to call it.
  template <typename Use>
  [[nodiscard]] auto with_image(int index, Use use) const {
    const rosbag::MessageInstance& message = messages_.at(static_cast<std::size_t>(index));
    const std::string what = name_ + ", image " + std::to_string(index);
    if (const auto image = message.instantiate<ros1::Image>()) return use(*image, what);
    if (const auto packed = message.instantiate<ros1::CompressedImage>()) return use(*packed, what);
    throw std::runtime_error(what + ": is a " + message.getDataType());
  }

 private:
  using Time = std::int64_t Info::*;

  /// Those with no time in their header, or one before that of an earlier image. What is repeated
  /// has the same.
  static std::size_t num_without_time(const std::vector<Info>& infos) {
    std::size_t count = 0;
    std::int64_t latest = 0;
    for (const Info& info : infos) {
      if (info.utime == 0 || info.utime < latest) ++count;
      latest = std::max(latest, info.utime);
    }
    return count;
  }

  /// Drivers repeat an image, and clocks that are set step back: only what is later counts.
  void keep_ascending(const std::vector<Info>& infos, Time time) {
    std::vector<rosbag::MessageInstance> all = std::exchange(messages_, {});
    for (std::size_t i = 0; i < infos.size(); ++i) {
      if (!utimes_.empty() && infos[i].*time <= utimes_.back()) continue;
      utimes_.push_back(infos[i].*time);
      messages_.push_back(all[i]);
    }
    num_left_out_ = std::ssize(infos) - std::ssize(utimes_);
  }

  static Info info_of(const rosbag::MessageInstance& message) {
    if (const auto image = message.instantiate<ros1::Image>()) {
      return {.utime = utime_of(image->header.stamp),
              .recorded_utime = 0,
              .frame = ros1::plain(image->header.frame_id),
              .size = {static_cast<int>(image->width), static_cast<int>(image->height)},
              .is_metric = image->encoding == "32FC1"};
    }
    if (const auto packed = message.instantiate<ros1::CompressedImage>()) {
      return {.utime = utime_of(packed->header.stamp),
              .recorded_utime = 0,
              .frame = ros1::plain(packed->header.frame_id),
              .size = {},
              .is_metric = packed->format.starts_with("32FC1")};
    }
    throw std::runtime_error(message.getTopic() + ": is a " + message.getDataType() +
                             ", expected sensor_msgs/Image or sensor_msgs/CompressedImage");
  }

  std::string name_;
  std::unique_ptr<rosbag::View> view_;  // the messages refer to it
  std::vector<rosbag::MessageInstance> messages_;
  std::vector<std::int64_t> utimes_;
  bool takes_recorded_times_ = false;
  std::int64_t num_left_out_ = 0;
  Info first_;
};

cv::Size size_of(const Intrinsics& camera) { return {camera.width, camera.height}; }

/// What rosbag throws, and what we do, names no file.
template <typename Read>
auto naming(const std::string& file, Read read) {
  try {
    return read();
  } catch (const std::exception& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
}

class BagImages : public ImageStore {
 public:
  BagImages(std::unique_ptr<rosbag::Bag> bag, ImageTopic depth, ImageTopic color,
            cv::Size depth_size, cv::Size color_size)
      : bag_(std::move(bag)),
        depth_(std::move(depth)),
        color_(std::move(color)),
        depth_size_(depth_size),
        color_size_(color_size) {}

  [[nodiscard]] cv::Mat depth(int index) override {
    return naming(bag_->getFileName(), [&] {
      return depth_.with_image(index, [&](const auto& image, const std::string& what) {
        return ros1::depth_of(image, depth_size_, what);
      });
    });
  }

  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override {
    return naming(bag_->getFileName(), [&] {
      return color_.with_image(index, [&](const auto& image, const std::string& what) {
        return ros1::color_of(image, color_size_, what);
      });
    });
  }

 private:
  std::unique_ptr<rosbag::Bag> bag_;
  ImageTopic depth_;
  ImageTopic color_;
  cv::Size depth_size_;
  cv::Size color_size_;
};

std::vector<ros1::Topic> topics_of(const rosbag::Bag& bag) {
  rosbag::View view(bag);
  std::map<std::string, std::string> types;  // several publishers of a topic are one
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    types.emplace(connection->topic, connection->datatype);
  }
  std::vector<ros1::Topic> topics;
  topics.reserve(types.size());
  for (const auto& [name, type] : types) topics.push_back({name, type});
  return topics;
}

/// The coefficients of a lens, of which only one model is known.
std::array<double, 5> distortion_of(const ros1::CameraInfo& info, const std::string& topic,
                                    std::vector<std::string>& remarks) {
  std::array<double, 5> distortion{};
  if (info.distortion_model == "plumb_bob") {
    std::copy_n(info.D.begin(), std::min(distortion.size(), info.D.size()), distortion.begin());
  } else if (std::ranges::any_of(info.D, [](double k) { return k != 0.0; })) {
    remarks.push_back("the lens model '" + ros1::plain(info.distortion_model) + "' of " + topic +
                      " is not known: its images are taken as free of distortion; --calibration "
                      "gives another camera");
  }
  return distortion;
}

/// @throws std::runtime_error when no camera has these numbers
void check_numbers(const Intrinsics& camera, const std::string& topic) {
  constexpr double kMax_px = 1e6;
  const auto is_length = [](double px) { return px > 1e-3 && px <= kMax_px; };
  const auto is_place = [](double px) { return std::abs(px) <= kMax_px; };
  const bool is_camera =
      is_length(camera.fx) && is_length(camera.fy) && is_place(camera.cx) && is_place(camera.cy) &&
      std::ranges::all_of(camera.distortion, [](double k) { return std::abs(k) <= 1e3; });
  if (!is_camera) throw std::runtime_error(topic + ": K or D is not a camera's");
}

/// The first camera of the topic that is one.
Intrinsics camera_of(const rosbag::Bag& bag, const std::string& topic, const char* what,
                     std::vector<std::string>& remarks) {
  if (!topic.empty()) {
    for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
      const auto info = message.instantiate<ros1::CameraInfo>();
      if (!info || !(info->K[0] > 0.0 && info->K[4] > 0.0)) continue;
      Intrinsics camera{.fx = info->K[0],
                        .fy = info->K[4],
                        .cx = info->K[2],
                        .cy = info->K[5],
                        .width = static_cast<int>(info->width),
                        .height = static_cast<int>(info->height),
                        .distortion = distortion_of(*info, topic, remarks)};
      check_numbers(camera, topic);
      return camera;
    }
  }
  throw std::runtime_error(std::string("no sensor_msgs/CameraInfo of the ") + what +
                           " images with a focal length" +
                           (topic.empty() ? "" : " in the topic " + topic));
}

/// @param size of the images, 0x0 when they do not say
void check_size(const Intrinsics& camera, cv::Size size, const std::string& topic) {
  constexpr int kMaxSide = 4096;  // what is made for a camera takes memory by its size
  const bool is_size = camera.width > 0 && camera.width <= kMaxSide && camera.height > 0 &&
                       camera.height <= kMaxSide;
  if (is_size && (size.empty() || size == size_of(camera))) return;
  throw std::runtime_error(topic + ": images of " + std::to_string(size.width) + "x" +
                           std::to_string(size.height) + ", but its CameraInfo is of " +
                           std::to_string(camera.width) + "x" + std::to_string(camera.height));
}

std::optional<ColorCamera> color_camera_of(const rosbag::Bag& bag, const CameraTopics& topics,
                                           const ImageTopic& depth, const ImageTopic& color,
                                           const Intrinsics& depth_camera,
                                           std::vector<std::string>& remarks) {
  const Intrinsics camera = topics.color_camera == topics.depth_camera
                                ? depth_camera
                                : camera_of(bag, topics.color_camera, "colour", remarks);
  check_size(camera, color.first().size, color.name());
  if (ros1::is_registered(topics.depth) && camera == depth_camera) return std::nullopt;
  ColorCamera result{.intrinsics = camera};
  if (ros1::is_registered(topics.depth) || depth.first().frame == color.first().frame) {
    return camera == depth_camera ? std::nullopt : std::optional(result);
  }
  const auto X_RC = ros1::fixed_transform(bag, color.first().frame, depth.first().frame);
  if (X_RC) {
    result.X_RC = *X_RC;
  } else {
    remarks.push_back("the bag does not say where the colour camera is (no /tf_static from '" +
                      depth.first().frame + "' to '" + color.first().frame +
                      "'): it is taken to be where the depth camera is");
  }
  return result;
}

RecordingContents read(const fs::path& path, const BagTopics& wanted) {
  auto bag = std::make_unique<rosbag::Bag>(path.string(), rosbag::bagmode::Read);
  check_bag_index(path);
  const CameraTopics topics = ros1::choose_topics(topics_of(*bag), wanted.depth, wanted.color);
  ImageTopic depth(*bag, topics.depth);
  ImageTopic color(*bag, topics.color);
  RecordingContents contents;
  contents.format = "bag of ROS 1";
  contents.name = path.filename().string();
  contents.remarks.push_back(
      "depth is " + topics.depth + " with the camera of " + topics.depth_camera +
      (topics.color.empty() ? ", there is no colour" : ", colour is " + topics.color));
  for (const ImageTopic* images : {&depth, &color}) images->tell_what_is_left_out(contents.remarks);
  const Intrinsics camera = camera_of(*bag, topics.depth_camera, "depth", contents.remarks);
  check_size(camera, depth.first().size, depth.name());
  contents.calibration = {
      .intrinsics = camera,
      .depth_units_per_m = depth.first().is_metric ? kFinestUnits_per_m : kMillimetres_per_m};
  cv::Size color_size = size_of(camera);
  if (!topics.color.empty()) {
    contents.color_camera = color_camera_of(*bag, topics, depth, color, camera, contents.remarks);
    if (contents.color_camera) color_size = size_of(contents.color_camera->intrinsics);
  }
  contents.depth_utimes = depth.utimes();
  contents.color_utimes = color.utimes();
  contents.images = std::make_unique<BagImages>(std::move(bag), std::move(depth), std::move(color),
                                                size_of(camera), color_size);
  return contents;
}

}  // namespace

bool is_ros_bag(const fs::path& path) {
  try {
    constexpr std::string_view kMagic = "#ROSBAG V2.0";
    const auto bytes = BinaryFile(path).read_bytes(static_cast<std::int64_t>(kMagic.size()));
    return std::ranges::equal(bytes, kMagic, {}, {},
                              [](char c) { return static_cast<std::uint8_t>(c); });
  } catch (const std::runtime_error&) {
    return false;
  }
}

RecordingContents read_ros_bag(const fs::path& path, const BagTopics& topics) {
  return naming(path.string(), [&] {
    try {
      return read(path, topics);
    } catch (const rosbag::BagUnindexedException&) {
      throw std::runtime_error(
          "has no index, as it was cut off while it was recorded; 'rosbag reindex' mends it");
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error(
          std::string("is damaged or cut off, which 'rosbag reindex' may mend: ") + error.what());
    }
  });
}

}  // namespace kintsugi::mapper
