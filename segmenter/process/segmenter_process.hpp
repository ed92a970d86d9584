#pragma once
// The segmenter between the bus, or a log, and its files.

#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/bus_thread.hpp"
#include "segmenter/process/map_writer.hpp"
#include "segmenter/process/slice_processor.hpp"
#include "segmenter/process/slice_queue.hpp"
#include "segmenter/process/slice_receiver.hpp"
#include "segmenter/process/update_publisher.hpp"

namespace kintsugi::segmenter {

/// Threads that do not wait for each other, each in one stage of a slice's way:
///   receiving   decodes and joins chunks, from the bus or from a log as fast as it can be read
///   working     drops duplicates, puts slices in order, runs the engine, which looks for the
///               neighbours of the next slice meanwhile
///   publishing  (the publisher's) encodes updates and sends them at its pace
///   writing     (the writer's) puts copies of the map into files
/// Between two stages lies a queue without a bound: a slice is never dropped, however far behind
/// the engine is. run() itself publishes the status, the lag in it, and watches for the end.
class SegmenterProcess {
 public:
  struct Config {
    SliceProcessor::Config processor;
    std::string lcm_url;        ///< empty: the default bus
    std::filesystem::path log;  ///< read slices from this log; empty: from the bus
    bool publish = true;        ///< updates and status on the bus
    MapWriter::Config files;
    std::filesystem::path resume_file;  ///< go on with the map kept here; empty: begin anew
    bool exit_on_final = false;         ///< end when the final slice is segmented and published
    std::chrono::milliseconds status_period{250};  ///< > 0
    StreamPublisher::Config publisher;

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  /// Opens the bus. Throws std::invalid_argument for an invalid config, std::runtime_error where
  /// it cannot be opened.
  explicit SegmenterProcess(const Config& config);
  ~SegmenterProcess();

  /// Works until the end of the log, the final slice (Config::exit_on_final) or a stop signal;
  /// then writes the map. Returns the exit status: 0, or 1 when a file could not be written, an
  /// update not be sent, the log is damaged, or slices are missing at the end. Throws what makes
  /// going on impossible, after it has tried to write the map.
  int run();

 private:
  // The thread of run().
  void receive();
  void watch();
  void publish_status();
  [[nodiscard]] bool has_ended() const;
  [[nodiscard]] bool nothing_is_queued() const;
  [[nodiscard]] int exit_status() const;

  // The working thread.
  void work();
  void work_until_end();
  void offer_all(std::vector<CloudSlice> slices);
  void write(const SegmentMap& map, SliceProcessor::Save why);

  [[nodiscard]] SliceProcessor::Counts counts() const;

  Config config_;
  std::int64_t session_;
  std::unique_ptr<Bus> bus_;  // null: neither heard nor published
  UpdatePublisher updates_;
  SliceQueue queue_;
  SliceReceiver receiver_;
  MapWriter writer_;
  SliceProcessor processor_;  // of the working thread

  mutable std::mutex mutex_;  // guards what the working thread tells the others
  SliceProcessor::Counts counts_;

  std::exception_ptr failure_;  // of the working thread; read when it has ended
  std::string status_problem_;  // of the thread of run()
  std::atomic<bool> ending_{false};
  std::atomic<bool> working_{true};
  std::unique_ptr<BusThread> bus_thread_;  // last: it uses the rest
};

}  // namespace kintsugi::segmenter
