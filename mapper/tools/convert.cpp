// kintsugi-convert: a recording of one format as one of another.

#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "mapper/conversion/recording_writer.hpp"
#include "mapper/source/open_source.hpp"
#include "mapper/source/recorded_poses.hpp"
#include "mapper/tools/progress.hpp"

namespace {

using kintsugi::mapper::FrameSource;
using kintsugi::mapper::RecordingWriter;
using kintsugi::mapper::RgbdFrame;
using kintsugi::mapper::SourceConfig;
using kintsugi::mapper::SourceNotice;

struct Options {
  SourceConfig source;
  std::string output;
  kintsugi::mapper::WritingOptions writing;
  int max_frames = 0;
};

/// At most `max_frames`, if that is not 0; returns how many there were.
int copy_frames(FrameSource& source, RecordingWriter& writer, int max_frames) {
  const int total = static_cast<int>(source.status().frames_total);
  kintsugi::mapper::Progress progress;
  int num_frames = 0;
  while (max_frames == 0 || num_frames < max_frames) {
    const std::optional<RgbdFrame> frame = source.next();
    if (!frame) break;
    writer.add(*frame);
    progress.show(++num_frames, total);
  }
  return num_frames;
}

int convert(const Options& options) {
  const auto source = kintsugi::mapper::open_frame_source(options.source);
  const auto writer = kintsugi::mapper::open_recording_writer(options.output, options.writing);
  const int num_frames = copy_frames(*source, *writer, options.max_frames);
  if (kintsugi::stop_requested()) throw std::runtime_error("stopped; nothing was written");
  if (num_frames == 0) throw std::runtime_error("no frame can be read; nothing was written");
  const auto poses = kintsugi::mapper::recorded_poses(options.source.device);
  writer->finish(poses);
  const auto status = source->status();
  std::fprintf(stderr,
               "wrote %s: %d frames, %zu poses, %lld images could not be read, %lld were dropped\n",
               options.output.c_str(), num_frames, poses.size(),
               static_cast<long long>(status.counts.frames_bad),
               static_cast<long long>(status.counts.frames_dropped));
  if (status.ended_well) return 0;
  std::fprintf(stderr, "kintsugi-convert: %s\n", status.end_reason.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  kintsugi::install_stop_signals();
  return kintsugi::run_main(argv, [&] {
    Options options;
    options.source.max_range_m = 65.0;  // what the output can hold decides
    options.source.replay = true;       // to write takes longer than to send
    options.source.stop_requested = kintsugi::stop_requested;
    options.source.notify = [](const SourceNotice& notice) {
      std::fprintf(stderr, "%s\n", notice.text.c_str());
    };
    CLI::App app("Converts a recording of any format that kintsugi-mapper reads.");
    app.option_defaults()->always_capture_default();
    app.add_option("IN", options.source.device,
                   "a recording: its path, or an address as of --device of kintsugi-mapper")
        ->required();
    app.add_option("OUT", options.output,
                   "FILE.klg (Kintinuous, ElasticFusion), FILE.lcm (raw frames for lcm-logplayer "
                   "and --device lcm://RGBD_FRAME), or a folder in TUM layout; must not exist")
        ->required();
    app.add_option("--calibration", options.source.calibration_file,
                   "camera.txt of the camera; empty: what the recording says");
    app.add_option("--jpeg-quality", options.writing.jpeg_quality,
                   "of colour in .klg and .lcm files, 1 to 100; 0: without loss");
    app.add_option("--max-frames", options.max_frames, "stop after N frames; 0: all")
        ->check(CLI::NonNegativeNumber);
    kintsugi::add_bus_key_flag(app);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    return convert(options);
  });
}
