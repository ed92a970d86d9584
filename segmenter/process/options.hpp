#pragma once
// The command line of kintsugi-segmenter, and the flags that all programs of the segmenter share.

#include <filesystem>
#include <string_view>
#include <variant>

#include "segmenter/map/segment_map.hpp"
#include "segmenter/process/segmenter_process.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

/// What the command line of kintsugi-segmenter sets; config() turns it into that of the process.
struct Options {
  SegmenterProcess::Config process;
  double gap_timeout_s = 10.0;        ///< SliceSequencer::Config::gap_timeout
  double max_queue_mb = 1024.0;       ///< SegmenterProcess::Config::max_queue_bytes, 1e6 bytes each
  double rate_mb_per_s = 10.0;        ///< UpdatePublisher::Config::rate_bytes_per_s
  double max_memory_mb = 0.0;         ///< SwapSpace::Config::max_anonymous_bytes; 0: no limit
  std::filesystem::path swap_folder;  ///< SwapSpace::Config::folder; empty: that of the map files
  bool resume_if_saved = false;       ///< resume the map that --save has left, if there is one

  /// @throws std::invalid_argument for flags that do not fit together
  SegmenterProcess::Config config() const;
};

/// Reads the command line, and the --config file it names. Returns the options, or the exit code
/// when there is nothing to run: help, the printed configuration, or a wrong flag (explained on
/// stderr).
std::variant<Options, int> parse_options(int argc, const char* const* argv);

/// Adds --mode, --audit, --preset (`default_preset` unless given), --neighbours and an option for
/// each of kMapParameters that does not come with slices. They set `config`; a parameter that is
/// given counts, whatever the preset and wherever in the line it stands. Bounds are checked by
/// config.validate().
void add_segmentation_options(CLI::App& app, SegmentMapConfig& config,
                              std::string_view default_preset = "objects");

}  // namespace kintsugi::segmenter
