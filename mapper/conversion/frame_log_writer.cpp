#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "mapper/conversion/writers.hpp"
#include "mapper/source/bus/rgbd_frame_encoder.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

std::int64_t session_of_now() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

class FrameLogWriter : public RecordingWriter {
 public:
  FrameLogWriter(fs::path path, const WritingOptions& options)
      : path_(std::move(path)),
        partial_(path_.string() + ".partial"),
        options_(options),
        session_(session_of_now()),
        log_(make_log(partial_)),
        stream_([this](const std::string& channel, ByteView message) { append(channel, message); },
                channels::kRgbdFrame, session_, unlimited()) {
    if (const auto key = bus_key()) signer_.emplace(key);
  }

  ~FrameLogWriter() override {
    std::error_code ignored;
    fs::remove(partial_, ignored);
  }
  FrameLogWriter(const FrameLogWriter&) = delete;
  FrameLogWriter& operator=(const FrameLogWriter&) = delete;

  void add(const RgbdFrame& frame) override {
    utime_ = frame.utime;  // at which lcm-logplayer plays it
    stream_.publish(encode_rgbd_frame(frame, session_, options_.jpeg_quality));
    stream_.flush();  // before the next one's time
  }

  void finish(const Trajectory& /*poses*/) override {
    stream_.flush();
    log_.sync();
    fs::rename(partial_, path_);
  }

 private:
  void append(const std::string& channel, ByteView message) {
    const Bytes bytes = signer_ ? signer_->sign(channel, message) : Bytes();
    (void)log_.append(utime_, channel, signer_ ? ByteView(bytes) : message);
  }

  static LogWriter make_log(const fs::path& file) {
    fs::remove(file);  // of a conversion that was killed
    return LogWriter::create(file);
  }

  /// A file does not overflow as a receive buffer does, and nobody listens to heartbeats.
  static StreamPublisherConfig unlimited() {
    StreamPublisherConfig config;
    config.rate_bytes_per_s = 1e12;
    config.burst_bytes = std::size_t{1} << 30U;
    config.heartbeat_period = std::chrono::hours(24);
    return config;
  }

  fs::path path_;
  fs::path partial_;
  WritingOptions options_;
  std::int64_t session_;
  std::atomic<std::int64_t> utime_ = 0;  ///< read by the stream's thread
  LogWriter log_;
  std::optional<MessageSigner> signer_;  ///< with a key
  StreamPublisher stream_;
};

}  // namespace

std::unique_ptr<RecordingWriter> make_frame_log_writer(const fs::path& file,
                                                       const WritingOptions& options) {
  return std::make_unique<FrameLogWriter>(file, options);
}

}  // namespace kintsugi::mapper
