#pragma once
// The segmenter between the bus, or a log, and its files.

#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/stream_publisher.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "segmenter/background_writer.hpp"
#include "segmenter/slice_processor.hpp"
#include "segmenter/slice_queue.hpp"

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
    std::filesystem::path output_folder = ".";
    std::filesystem::path save_file;    ///< also keep the map here, to go on with; empty: do not
    std::filesystem::path resume_file;  ///< go on with the map kept here; empty: begin anew
    bool exit_on_final = false;         ///< end when the final slice is segmented and published
    std::chrono::milliseconds status_period{250};  ///< > 0
    StreamPublisher::Config publisher;

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  /// Opens bus and log. Throws std::invalid_argument for an invalid config, std::runtime_error
  /// where they cannot be opened.
  explicit SegmenterProcess(const Config& config);
  ~SegmenterProcess();

  /// Works until the end of the log, the final slice (Config::exit_on_final) or a stop signal;
  /// then writes the map. Returns the exit status: 0, or 1 when a file could not be written, an
  /// update not be sent, the log is damaged, or slices are missing at the end. Throws what makes
  /// going on impossible, after it has tried to write the map.
  int run();

 private:
  void receive_from_bus();
  void receive_from_log();
  void work();
  void work_until_end();
  void resume();
  void offer_all(std::vector<CloudSlice> slices);
  void publish(SegmentUpdate update);
  void save(const SegmentMap& map, SliceProcessor::Save why);
  template <class Action>
  void try_to_write(Action&& action);
  void tell_what_was_done() const;
  void fail(const std::string& what);
  void publish_status();
  void wait_for_end();
  [[nodiscard]] SliceProcessor::Counts counts() const;
  [[nodiscard]] bool nothing_is_queued() const;

  Config config_;
  std::int64_t session_;
  std::unique_ptr<Bus> bus_;                    // null: nothing is published
  std::unique_ptr<StreamPublisher> publisher_;  // null likewise
  SliceQueue queue_;
  StreamSubscriber<CloudSlice> subscriber_;
  BackgroundWriter writer_;
  SliceProcessor processor_;  // of the working thread

  mutable std::mutex mutex_;  // guards what the working thread tells the others
  SliceProcessor::Counts counts_;

  std::exception_ptr failure_;      // of the working thread; read when it has ended
  bool status_has_failed_ = false;  // of the thread of run()
  std::atomic<bool> ending_{false};
  std::atomic<bool> working_{true};
  std::atomic<bool> has_failed_{false};    // in something that did not stop the work
  std::atomic<bool> is_write_due_{false};  // the files of the last writing are not there
};

}  // namespace kintsugi::segmenter
