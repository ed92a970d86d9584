#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/source/frames/source_config.hpp"

namespace kintsugi::mapper {

/// The options of a run of kintsugi-mapper. Every member that a flag sets has a row in
/// option_table().
struct Options {
  SourceConfig source;
  double max_range_m = 0.0;       ///< depth beyond it is not used; 0: as --max-range says
  double lock_exposure_s = -1.0;  ///< after the first image; < 0: never
  MapperPipeline::Config pipeline;
  std::string volume;  ///< "range" or "cube"; empty: as --volume says
  std::string slices = "patch";
  double volume_size_m = 0.0;    ///< side of the cube; 0: that of TsdfVolume::Config
  double resolution_m = 0.0;     ///< side of a voxel; 0: that of TsdfVolume::Config
  bool no_loop_closure = false;  ///< the map is not corrected
  std::string sensor;            ///< see noise_of_sensor(); empty: by the size of the image
  std::string depth_noise;  ///< "BASE,SHARE,GROWTH", fixed; empty: as of the sensor, and learned
  std::string given_path_file;   ///< TUM; empty: track
  std::string output_path_file;  ///< TUM, corrected; empty: none is written
  std::string online_path_file;  ///< TUM, as believed at each frame; empty: none is written
  std::string cloud_file;        ///< PLY; empty: none is written
  std::string mesh_file;         ///< PLY; empty: none is made
  std::string timings_file;      ///< CSV, one line per frame; empty: none is written
  std::string ground_truth_dir;  ///< of a synthetic:// device; empty: no ground truth is written
  std::int64_t max_frames = 0;   ///< 0: no limit
  bool publish_frames = false;   ///< RGBD_FRAME, too
  double view_rate_hz = 10.0;    ///< of CAMERA_VIEW; 0: none
  std::string lcm_url;           ///< empty: LCM's default
  std::string map_name = "map";
  std::string join;          ///< name of another mapper's map, which this one joins; empty: none
  std::int64_t session = 0;  ///< of part 0, > 0; 0: from the clock, or that of the resumed session
  double rate_mb_s = 10.0;   ///< of slices and frames on the bus, 1e6 bytes per second
  std::string store_file;    ///< LCM log of all published messages; empty: an unnamed one
  std::string resume_file;   ///< log to continue, instead of store_file; empty: a new session
  double store_file_size_mb = 1000.0;  ///< above it another file begins
  double store_limit_mb = 0.0;         ///< of all files of the log; 0: without limit
  bool durable = false;                ///< a power cut takes at most the last second of the log
  bool store_frames = false;  ///< raw frames, too, so that a camera's session can be resumed
  double linger_s = 2.0;      ///< time without requests after which to exit; < 0: never
  int threads = 0;            ///< of the parallel stages; 0: one per core
};

/// Whether --resume demands the value with which the session was begun.
enum class OnResume {
  kMustMatch,  ///< the slices depend on it
  kMayDiffer,
};

/// Bounds of a number, inclusive.
struct Bounds {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
};

/// A member of Options that a flag sets.
using OptionValue = std::variant<bool*, int*, std::int64_t*, double*, std::string*>;

/// An option of kintsugi-mapper: a row of the table from which the flags, the check of bounds and
/// the check on --resume are made.
class MapperOption {
 public:
  /// @param help without unit and bounds, which help() appends
  /// @param unit empty: none
  /// @param bounds checked by check_bounds(); bounds of members that belong to SourceConfig or
  ///   MapperPipeline::Config are checked there
  MapperOption(std::string flag, OptionValue value, OnResume on_resume, std::string help,
               std::string unit = "", Bounds bounds = {});

  const std::string& flag() const { return flag_; }
  OptionValue value() const { return value_; }
  OnResume on_resume() const { return on_resume_; }
  std::string help() const;
  std::string value_text() const;

  /// @throws std::invalid_argument naming flag, value and bounds; NaN is always refused
  void check_bounds() const;

 private:
  std::string flag_;
  OptionValue value_;
  OnResume on_resume_;
  std::string help_;
  std::string unit_;
  Bounds bounds_;
};

/// The title of the options of the bus.
inline constexpr char kBusGroup[] = "The bus";

struct OptionGroup {
  std::string title;  ///< in --help
  std::vector<MapperOption> options;
};

/// Every option of kintsugi-mapper that sets a member of Options. The values point into `options`.
std::vector<OptionGroup> option_table(Options& options);

}  // namespace kintsugi::mapper
