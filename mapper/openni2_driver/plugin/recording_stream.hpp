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
  /// @param modes of the stream, not empty; the first is the initial one
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
  /// Returns the same pixel, because colour is registered to depth.
  OniStatus convertDepthToColorCoordinates(StreamBase* color, int depth_x, int depth_y,
                                           OniDepthPixel depth, int* color_x,
                                           int* color_y) override;

  /// Passes a frame to OpenNI2 with the mode, mirroring and cropping that are set. Called from the
  /// playing thread. Returns false when the frame rate of the mode skips it.
  bool deliver(const PlayedFrame& frame);

  /// Image size of the present mode.
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
