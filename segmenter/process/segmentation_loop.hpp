#pragma once
// The thread that segments: from the queue of slices to updates and files.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/swap_space.hpp"
#include "segmenter/output/map_writer.hpp"
#include "segmenter/process/query_responder.hpp"
#include "segmenter/process/slice_queue.hpp"
#include "segmenter/process/slice_receiver.hpp"
#include "segmenter/process/update_publisher.hpp"
#include "segmenter/process/view_recorder.hpp"
#include "segmenter/session/session_maps.hpp"

namespace kintsugi::segmenter {

/// Takes slices from a queue, adds them to the maps, publishes the updates and writes what is to be
/// saved. Between two steps it sends the full state to late joiners and begins to answer queries.
class SegmentationLoop {
 public:
  struct Config {
    SessionMaps::Config maps;
    MapWriter::Config files;
    std::optional<SwapSpace::Config> swap;  ///< where maps beyond memory go; nothing: nowhere
    std::filesystem::path resume_file;      ///< a saved map to resume; empty: begin without a map
    /// A file that could not be written is tried again after this time, and when files are due; > 0
    std::chrono::milliseconds rewrite_period{10'000};

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };
  /// What the loop works with; must outlive it.
  struct Connections {
    SliceQueue& queue;
    SliceReceiver& receiver;
    UpdatePublisher& updates;
    QueryResponder& queries;
    PatientClock& clock;
    ViewRecorder* views = nullptr;  ///< what is saved beside the map; null: nothing
  };

  /// @param session of this segmenter
  /// @throws std::invalid_argument for an invalid config
  SegmentationLoop(const Config& config, std::int64_t session, const Connections& connections);

  /// Segments until the queue is closed and empty, or end() was called, and then what is left;
  /// waits until the maps are written. For a thread of its own.
  /// @throws what makes going on impossible, after it has tried to write the maps
  void run();

  /// Publishes full states, begins answers, and writes files that are due. run() calls it; after
  /// run() has returned, another thread may.
  void serve();

  /// Waits until everything handed to the writer is written, or has failed.
  void wait_for_files() { writer_.wait(); }

  // From any thread:
  /// Makes run() finish what was received and return.
  void end() { is_ending_ = true; }
  /// The saved map is there, if there is one to resume: what it has need not be asked for.
  bool has_resumed() const { return has_resumed_; }
  SessionMaps::Counts counts() const;
  /// Which file is not written, and why; empty: none.
  std::string file_problem() const;

 private:
  using Clock = SessionMaps::Clock;

  void resume();
  MapWriter::Views views_of(const SegmentMap& map) const;
  void segment_until_end();
  void segment_rest();
  void add(std::vector<CloudSlice> slices);
  bool step();
  void trim_memory();
  void write_all(const std::vector<SaveRequest>& requests);
  void write(const SaveRequest& request);
  void update_counts();
  StreamState stream_state(std::int64_t map_session) const;
  Clock::time_point now() const;

  Config config_;
  std::int64_t session_;
  Connections with_;
  std::optional<SwapSpace> swap_;  // of maps_
  MapWriter writer_;
  SessionMaps maps_;
  Clock::time_point next_rewrite_{};
  std::atomic<bool> is_ending_{false};
  std::atomic<bool> has_resumed_{false};

  mutable std::mutex mutex_;    // guards the next against readers
  SessionMaps::Counts counts_;  // written by the thread of run() alone
  std::string swap_problem_;
};

}  // namespace kintsugi::segmenter
