#pragma once
// The segmenter between the bus, or a log, and its files.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "segmenter/process/map_writer.hpp"
#include "segmenter/process/query_responder.hpp"
#include "segmenter/process/session_maps.hpp"
#include "segmenter/process/slice_queue.hpp"
#include "segmenter/process/slice_receiver.hpp"
#include "segmenter/process/update_publisher.hpp"

namespace kintsugi::segmenter {

/// Threads that do not wait for each other, each in one stage of a slice's way:
///   receiving   decodes and joins chunks and asks for missing ones; from a log: as fast as there
///               is room for
///   working     drops duplicates, puts slices in order, runs the engine, which looks for the
///               neighbours of the next slice meanwhile; says everything to who comes late
///   publishing  (the publisher's) encodes updates and sends them at its pace, and what was lost
///   writing     (the writer's) puts copies of the maps into files
///   answering   (the responder's) says what a copy of a map has to say to a query
/// Between two stages lies a queue with a bound: slices beyond it are refused, and asked for again
/// when there is room. run() itself publishes the status, the lag in it, and watches for the end.
class SegmenterProcess {
 public:
  struct Config {
    SessionMaps::Config maps;
    std::string lcm_url;        ///< empty: the default bus
    std::filesystem::path log;  ///< read slices from this log; empty: from the bus
    bool publish = true;        ///< updates and status on the bus
    /// Slices received and not segmented, and as much again of incomplete ones; > 0.
    std::size_t max_queue_bytes = std::size_t{1} << 30U;
    UpdatePublisher::Config updates;
    MapWriter::Config files;
    std::filesystem::path resume_file;  ///< go on with the map kept here; empty: begin anew
    bool exit_on_final = false;         ///< end when the final slice is segmented and published
    /// After the end stay until nobody has asked for anything for so long, or a stop signal comes;
    /// < 0: until one comes, or for 2 s when one has brought the end. Only when publishing.
    double linger_s = 2.0;
    std::chrono::milliseconds status_period{250};  ///< > 0
    /// What could not be written is written again after so long, and whenever files are due; > 0.
    std::chrono::milliseconds rewrite_period{10'000};

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  /// Opens the bus. Throws std::invalid_argument for an invalid config, std::runtime_error where
  /// it cannot be opened.
  explicit SegmenterProcess(const Config& config);
  ~SegmenterProcess();

  /// Works until the end of the log, the final slice (Config::exit_on_final) or a stop signal;
  /// writes the maps, and lingers. Returns the exit status: 0, or 1 when a file is not written, an
  /// update was not sent, the log is damaged, or slices are missing at the end. Throws what makes
  /// going on impossible, after it has tried to write the maps.
  int run();

 private:
  using Clock = SessionMaps::Clock;

  // The thread of run().
  void receive();
  void watch();
  void linger();
  void publish_status();
  [[nodiscard]] bool has_ended() const;
  [[nodiscard]] bool nothing_is_queued() const;
  [[nodiscard]] std::string problem() const;
  [[nodiscard]] int exit_status() const;

  // The working thread, and when it has ended that of run().
  void work();
  void work_until_end();
  void resume();
  void offer_all(std::vector<CloudSlice> slices);
  void answer();
  void save_what_is_due();
  void write(const SegmentMap& map, SessionMaps::Save why);
  [[nodiscard]] Clock::time_point now();
  [[nodiscard]] SliceStream slice_stream();

  [[nodiscard]] SessionMaps::Counts counts() const;

  Config config_;
  std::int64_t session_;
  PatientClock clock_;
  std::unique_ptr<Bus> bus_;  // null: neither heard nor published
  UpdatePublisher updates_;
  QueryResponder queries_;
  SliceQueue queue_;
  SliceReceiver receiver_;
  MapWriter writer_;
  SessionMaps maps_;  // of the working thread

  mutable std::mutex mutex_;  // guards what the working thread tells the others
  SessionMaps::Counts counts_;

  std::exception_ptr failure_;  // of the working thread; read when it has ended
  std::string status_problem_;  // of the thread of run()
  Clock::time_point next_rewrite_{};
  bool lingering_ = false;
  std::atomic<bool> ending_{false};
  std::atomic<bool> working_{true};
  std::unique_ptr<BusThread> bus_thread_;  // last: it uses the rest
};

}  // namespace kintsugi::segmenter
