#pragma once
// The files of the maps, written while the work goes on.

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/process/background_writer.hpp"

namespace kintsugi::segmenter {

/// Copies maps and writes the copies in a thread of its own. When a file cannot be written, what
/// was there stays, and this tells so until it is written after all. For one thread, but for what
/// is said of problem().
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

  /// Waits until everything handed in is written, or has failed.
  void wait() { writer_.wait(); }

  /// What could not be written when that was tried last; empty: nothing. From any thread.
  [[nodiscard]] std::string problem() const;

 private:
  using Snapshot = std::shared_ptr<const MapSnapshot>;

  [[nodiscard]] Snapshot copy(const SegmentMap& map);
  void put_files(const Snapshot& map, const std::string& stem);
  void put_saved(const Snapshot& map);
  template <class Action>
  void try_to(const std::string& what, const Action& action);

  Config config_;
  mutable std::mutex mutex_;                     // guards the next
  std::map<std::string, std::string> problems_;  // by what could not be done
  BackgroundWriter writer_;                      // last: its jobs use the rest
};

}  // namespace kintsugi::segmenter
