#pragma once
// Writes the files of the maps in the background.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/output/background_writer.hpp"
#include "segmenter/views/kept_view.hpp"

namespace kintsugi::segmenter {

/// Copies maps and writes the copies in a thread of its own. When a file cannot be written, the old
/// file stays, problem() reports it, and the copy is kept until it or a newer one is written. For
/// one thread, except problem().
class MapWriter {
 public:
  struct Config {
    std::filesystem::path folder = ".";  ///< of the files of write()
    std::filesystem::path save_file;     ///< of save(); empty: saves nothing
  };

  /// What the camera saw, to be saved beside the map; null: nothing is known of it.
  using Views = std::shared_ptr<const ViewSet>;

  explicit MapWriter(Config config) : config_(std::move(config)) {}

  /// Writes the map files in Config::folder: STEM.ply, STEM.json and STEM.csv, and the like of each
  /// further part (write_map_files()). What was written of a part that has been joined to another
  /// since is removed.
  void write(const SegmentMap& map, const std::string& stem);
  /// Writes the saved map, for --resume: Config::save_file, and views_file_of() that.
  void save(const SegmentMap& map, const Views& views = nullptr);
  /// Writes both from one copy.
  void write_and_save(const SegmentMap& map, const std::string& stem, const Views& views = nullptr);

  /// Tries again to write what could not be written.
  void try_again();

  /// Waits until everything is written, or has failed.
  void wait() { writer_.wait(); }

  /// Which file is not written, and why; empty: none. From any thread.
  std::string problem() const;

 private:
  using Snapshot = std::shared_ptr<const MapSnapshot>;
  using Action = std::function<void()>;
  struct Failure {
    Action action;
    std::string why;
  };

  Snapshot copy(const SegmentMap& map);
  void put_files(const Snapshot& map, const std::string& stem);
  void put_saved(const Snapshot& map, const Views& views);
  void write_files(const MapSnapshot& map, const std::string& stem);
  void put(const std::string& name, Action action);
  void attempt(const std::string& name, std::int64_t number, const Action& action);

  Config config_;
  std::mutex spare_mutex_;              // guards the next
  std::unique_ptr<MapSnapshot> spare_;  // memory of a copy that has been written, for the next one
  std::map<std::string, std::set<std::int32_t>> written_parts_;  // by stem; for jobs of writer_
  mutable std::mutex mutex_;                                     // guards what follows
  std::map<std::string, std::int64_t> newest_;  // number of the newest action of each name
  std::map<std::string, Failure> failures_;     // by name of the action
  std::int64_t num_failures_ = 0;               // since the last success
  BackgroundWriter writer_;                     // last: its jobs use the others
};

}  // namespace kintsugi::segmenter
