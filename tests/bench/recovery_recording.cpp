#include "tests/bench/recovery_recording.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/source/open_source.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::mapper::bench {
namespace {

constexpr double kUnitsPerMetre = 1e4;

}  // namespace

Recording::Recording(const std::string& device, int max_frames) {
  read_frames(device, max_frames);
  if (frames_.size() < 2) {
    throw std::runtime_error(device + ": " + std::to_string(frames_.size()) +
                             " frames, expected at least 2");
  }
  read_truth(device);
}

std::int64_t Recording::period_us() const {
  return (frames_.back().utime - frames_.front().utime) / (num_frames() - 1);
}

RgbdFrame Recording::frame(int index) const {
  const StoredFrame& stored = frames_.at(index);
  RgbdFrame frame;
  frame.utime = stored.utime - frames_.front().utime;
  frame.frame_index = index;
  frame.intrinsics = intrinsics_;
  stored.depth.convertTo(frame.depth_m, CV_32F, 1.0 / kUnitsPerMetre);
  frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), stored.depth == 0);
  frame.color_rgb = stored.color_rgb;
  return frame;
}

void Recording::read_frames(const std::string& device, int max_frames) {
  SourceConfig config;
  config.device = device;
  const auto source = open_frame_source(config);
  while (max_frames == 0 || num_frames() < max_frames) {
    auto frame = source->next();
    if (!frame) break;
    intrinsics_ = frame->intrinsics;
    StoredFrame stored{frame->utime, {}, frame->color_rgb};
    frame->depth_m.setTo(0.0F, frame->depth_m != frame->depth_m);
    frame->depth_m.convertTo(stored.depth, CV_16U, kUnitsPerMetre);
    frames_.push_back(std::move(stored));
  }
}

void Recording::read_truth(const std::string& device) {
  const auto uri = parse_recording_uri(device);
  X_WC_true_.resize(frames_.size());
  if (!uri) return;
  std::vector<std::optional<Pose>> X_TC(frames_.size());  // T: the frame of the truth
  if (uri->scheme == RecordingUri::Scheme::kSynthetic) {
    const synthetic::Sequence sequence(synthetic::Sequence::Config::parse(uri->path, uri->options));
    for (int i = 0; i < num_frames(); ++i) X_TC[i] = sequence.X_WC(i);
    truth_is_exact_ = true;
  } else {
    const std::filesystem::path file = std::filesystem::path(uri->path) / "groundtruth.txt";
    if (!std::filesystem::exists(file)) return;
    const Trajectory truth = read_tum_file(file.string());
    for (int i = 0; i < num_frames(); ++i) X_TC[i] = pose_at(truth, frames_[i].utime);
  }
  const auto first = std::find_if(X_TC.begin(), X_TC.end(),
                                  [](const std::optional<Pose>& X) { return X.has_value(); });
  if (first == X_TC.end()) return;
  const Pose X_CT_first = (*first)->inverse();
  for (int i = 0; i < num_frames(); ++i) {
    if (X_TC[i]) X_WC_true_[i] = X_CT_first * *X_TC[i];
  }
}

}  // namespace kintsugi::mapper::bench
