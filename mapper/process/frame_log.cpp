#include "mapper/process/frame_log.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "mapper/process/state_text.hpp"

namespace kintsugi::mapper {
namespace {

std::string header() {
  std::string line =
      "frame_index,utime_us,part,state,reason,first_reason,fused,"
      "frame_ms,cpu_ms,read_ms,convert_ms";
  for (const Stage& stage : kStages) line += std::string(",") + stage.name;
  return line +
         ",extract_ms,publish_ms,covered_share,overlap_share,inlier_share,behind_share,"
         "in_front_share,rms_m,sigma_m,rms_sigmas,iterations,undetermined,slices,memory_mb\n";
}

std::string line_of(const RgbdFrame& frame, int part, const TrackingResult& tracking, bool is_fused,
                    std::size_t num_slices, const FrameTimings& timings) {
  std::string line = fmt::format("{},{},{},{},{},{},{:d}", frame.frame_index, frame.utime, part,
                                 to_string(tracking.state), reason_text(tracking),
                                 first_reason_text(tracking), is_fused);
  const auto add_ms = [&line](double ms) { line += fmt::format(",{:.3f}", ms); };
  add_ms(timings.frame_ms);
  add_ms(timings.cpu_ms);
  add_ms(timings.read_ms);
  add_ms(timings.convert_ms);
  for (const Stage& stage : kStages) add_ms(timings.stages.*stage.ms);
  add_ms(timings.extract_ms);
  add_ms(timings.publish_ms);
  const RegistrationQuality& quality = tracking.quality;
  for (const double share : {quality.covered_share, quality.overlap_share, quality.inlier_share,
                             quality.behind_share, quality.in_front_share}) {
    line += fmt::format(",{:.4f}", share);
  }
  for (const double metres : {quality.rms_m, quality.sigma_m, quality.rms_sigmas}) {
    line += fmt::format(",{:.6f}", metres);
  }
  const double memory_mb = 1e-6 * static_cast<double>(process_memory().resident_bytes);
  return line + fmt::format(",{},{},{},{:.1f}\n", tracking.iterations, quality.undetermined,
                            num_slices, memory_mb);
}

}  // namespace

FrameLog::FrameLog(const std::filesystem::path& path) : path_(path), out_(path) {
  if (!(out_ << header() << std::flush)) {
    throw std::runtime_error(path_.string() + ": cannot be written: " + std::strerror(errno));
  }
}

void FrameLog::append(const RgbdFrame& frame, int part, const TrackingResult& tracking,
                      bool is_fused, std::size_t num_slices, const FrameTimings& timings) {
  if (!out_) return;
  if (out_ << line_of(frame, part, tracking, is_fused, num_slices, timings) << std::flush) return;
  spdlog::error("{}: {}; it ends before frame {}, mapping goes on", path_.string(),
                std::strerror(errno), frame.frame_index);
}

}  // namespace kintsugi::mapper
