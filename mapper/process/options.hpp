#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/session/mapping_options.hpp"
#include "mapper/source/frames/source_config.hpp"

namespace kintsugi::mapper {

/// The options of a run of kintsugi-mapper. Every member that a flag sets has a row in
/// option_table().
struct Options {
  SourceConfig source;
  double lock_exposure_s = -1.0;  ///< after the first image; < 0: never
  MapperPipeline::Config pipeline;
  double resolution_m = 0.0;     ///< side of a voxel; 0: 1/512 of the volume's side
  std::string given_path_file;   ///< TUM; empty: track
  std::string output_path_file;  ///< TUM; empty: none is written
  std::string cloud_file;        ///< PLY; empty: none is written
  std::string mesh_file;         ///< PLY; empty: none is made
  std::string timings_file;      ///< CSV, one line per frame; empty: none is written
  std::string ground_truth_dir;  ///< of a synthetic:// device; empty: no ground truth is written
  std::int64_t max_frames = 0;   ///< 0: no limit
  bool publish_frames = false;   ///< RGBD_FRAME, too
  std::string lcm_url;           ///< empty: LCM's default
  std::string map_name = "map";
  std::int64_t session = 0;  ///< > 0; 0: from the clock, or that of the resumed session
  double rate_mb_s = 10.0;   ///< of slices and frames on the bus, 1e6 bytes per second
  std::string store_file;    ///< LCM log of all published messages; empty: an unnamed one
  std::string resume_file;   ///< log to continue, instead of store_file; empty: a new session
  double store_file_size_mb = 1000.0;  ///< above it another file begins
  bool store_frames = false;  ///< raw frames, too, so that a camera's session can be resumed
  double linger_s = 2.0;      ///< time without requests after which to exit; < 0: never
  int threads = 0;            ///< of the parallel stages; 0: one per core

  /// @throws std::invalid_argument naming the flag or field, its value and its bound
  void validate() const;
};

/// The options that must match when a session is resumed. `options` as parse_options() returns
/// them.
MappingOptions mapping_options(const Options& options);

/// Reads the command line, the --config file, and the camera path that the options name. Returns
/// the options, or an exit code when there is nothing to run: after --help, --print-config,
/// --list-devices, or a wrong flag, which is reported on stderr.
/// @throws std::invalid_argument for a value out of its bounds, std::runtime_error for a file that
///   cannot be read
std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace kintsugi::mapper
