#pragma once
// The files of the maps, written while the work goes on.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/process/background_writer.hpp"

namespace kintsugi::segmenter {

/// Copies maps and writes the copies in a thread of its own. When a file cannot be written, what
/// was there stays; the copy is kept, and this tells so, until it is written after all or a newer
/// one is. For one thread, but for problem().
class MapWriter {
 public:
  struct Config {
    std::filesystem::path folder = ".";  ///< of the files of write()
    std::filesystem::path save_file;     ///< of save(); empty: saves nothing
  };

  explicit MapWriter(Config config) : config_(std::move(config)) {}

  /// STEM.ply and STEM.json in Config::folder: the map to look at.
  void write(const SegmentMap& map, const std::string& stem);
  /// Config::save_file: the map to go on with.
  void save(const SegmentMap& map);
  /// Both, of one copy.
  void write_and_save(const SegmentMap& map, const std::string& stem);

  /// Tries again what could not be written.
  void try_again();

  /// Waits until everything handed in is written, or has failed.
  void wait() { writer_.wait(); }

  /// What is not written, and why; empty: nothing. From any thread.
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
  void put_saved(const Snapshot& map);
  void put(const std::string& name, Action action);
  void attempt(const std::string& name, std::int64_t number, const Action& action);

  Config config_;
  std::mutex spare_mutex_;                      // guards the next
  std::unique_ptr<MapSnapshot> spare_;          // memory of a copy that is written
  mutable std::mutex mutex_;                    // guards what follows
  std::map<std::string, std::int64_t> newest_;  // number of the newest action, by its name
  std::map<std::string, Failure> failures_;     // likewise
  std::int64_t num_failures_ = 0;               // since the last success
  BackgroundWriter writer_;                     // last: its jobs use the rest
};

}  // namespace kintsugi::segmenter
