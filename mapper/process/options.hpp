#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/source/frame_source.hpp"

namespace kintsugi::mapper {

/// All that a run of kintsugi-mapper can be told; each has a flag.
struct Options {
  SourceConfig source;
  double lock_exposure_s = -1.0;  ///< after the first image; < 0: never
  MapperPipeline::Config pipeline;
  double resolution_m = 0.0;     ///< side of a voxel; 0: 1/512 of the volume's side
  std::string given_path_file;   ///< TUM; empty: track
  std::string output_path_file;  ///< TUM; empty: none is written
  std::string cloud_file;        ///< PLY; empty: none is written
  std::string mesh_file;         ///< PLY; empty: none is made
  std::string timings_file;      ///< CSV, a line a frame; empty: none is written
  std::string ground_truth_dir;  ///< where a synthetic:// device writes its truth; empty: nowhere
  std::int64_t max_frames = 0;   ///< 0: no limit
  bool publish_frames = false;   ///< RGBD_FRAME too
  std::string lcm_url;           ///< empty: LCM's default
  std::string map_name = "map";
  std::int64_t session = 0;  ///< > 0; 0: by the clock, or that of the log that is resumed
  double rate_mb_s = 10.0;   ///< of the bulk streams, 1e6 bytes a second
  std::string store_file;    ///< LCM log of what is published; empty: one without a name
  std::string resume_file;   ///< log to continue, instead of store_file; empty: begin anew
  double store_file_size_mb = 1000.0;  ///< then another file begins
  bool store_frames = false;  ///< raw frames too, so that a live camera's session can be resumed
  double linger_s = 2.0;      ///< stay until nobody has asked for so long; < 0: until a signal
  int threads = 0;            ///< for the parallel stages; 0: one per core

  /// @throws std::invalid_argument naming the field, its value and its bound
  void validate() const;
};

/// Reads the command line (and the --config file it names) and the files that belong to the
/// options. Gives the options, or the code to exit with when there is nothing to run: help, the
/// printed configuration or devices, or a flag that is wrong (said on stderr).
/// @throws std::invalid_argument for a value out of its bounds, std::runtime_error for a file that
///   cannot be read
std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace kintsugi::mapper
