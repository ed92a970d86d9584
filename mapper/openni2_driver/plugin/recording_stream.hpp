#pragma once

#include <mutex>
#include <vector>

#include "mapper/openni2_driver/plugin/camera_controls.hpp"
#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"
#include "mapper/openni2_driver/plugin/playback.hpp"
#include "mapper/openni2_driver/plugin/rate_filter.hpp"
#include "mapper/openni2_driver/recording/camera_imitation.hpp"

namespace kintsugi::mapper {

/// The depth or colour stream of a recording, as OpenNI2 sees it.
class RecordingStream : public oni::driver::StreamBase {
 public:
  /// @param modes what the stream offers, not empty; the first is in effect at first.
  RecordingStream(StreamKind kind, const Recording& recording, const CameraImitation& imitation,
                  Playback& playback, std::vector<OniVideoMode> modes);
  ~RecordingStream() override;
  RecordingStream(const RecordingStream&) = delete;
  RecordingStream& operator=(const RecordingStream&) = delete;

  OniStatus start() override;
  void stop() override;
  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  void notifyAllProperties() override;
  /// Colour is registered to depth: the same pixel.
  OniStatus convertDepthToColorCoordinates(StreamBase* color, int depth_x, int depth_y,
                                           OniDepthPixel depth, int* color_x,
                                           int* color_y) override;

  /// Hands a frame to OpenNI2 in the mode, mirrored and cropped as set. From the playback's thread.
  /// False when the mode's rate leaves it out.
  bool deliver(const PlayedFrame& frame);

  /// Of the mode in effect.
  [[nodiscard]] cv::Size image_size();

 private:
  [[nodiscard]] cv::Mat finish(const PlayedFrame& frame);
  OniStatus set_mirroring(bool mirrored);
  OniStatus set_mode(const OniVideoMode& mode);
  OniStatus set_cropping(const OniCropping& cropping);
  [[nodiscard]] DepthUnit depth_unit() const;
  [[nodiscard]] int bytes_per_pixel() const;
  [[nodiscard]] float field_of_view_rad(int pixels, double focal_length) const;

  const StreamKind kind_;
  const Recording& recording_;
  const CameraImitation& imitation_;
  Playback& playback_;
  const std::vector<OniVideoMode> modes_;

  std::mutex mutex_;  ///< guards what follows
  bool started_ = false;
  OniVideoMode mode_;
  OniCropping cropping_;
  bool mirrored_;
  CameraControls controls_;
  RateFilter rate_filter_;
};

}  // namespace kintsugi::mapper
