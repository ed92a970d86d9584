#pragma once
// The segmenter process: slices from the bus or a log, updates to the bus, maps to files.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "segmenter/process/query_responder.hpp"
#include "segmenter/process/segmentation_loop.hpp"
#include "segmenter/process/slice_queue.hpp"
#include "segmenter/process/slice_receiver.hpp"
#include "segmenter/process/update_publisher.hpp"
#include "segmenter/process/view_recorder.hpp"

namespace kintsugi::segmenter {

/// Connects the threads, none of which waits for another:
///   receiving   (SliceReceiver) decodes messages, joins chunks, requests missing ones
///   segmenting  (SegmentationLoop) orders slices, segments them, sends the full state to late
///               joiners
///   publishing  (UpdatePublisher) encodes updates, sends them at a limited rate, resends lost ones
///   writing     (MapWriter) writes copies of the maps into files
///   answering   (QueryResponder) answers queries from a copy of a map
/// The queue between receiving and segmenting is bounded: slices beyond it are refused, and
/// requested again when there is room. The thread of run() publishes the status and decides when to
/// end.
class SegmenterProcess {
 public:
  struct Config {
    SegmentationLoop::Config segmentation;
    std::string lcm_url;        ///< empty: the default bus
    std::filesystem::path log;  ///< read slices from this log; empty: from the bus
    bool publish = true;        ///< updates and status on the bus
    /// Slices received and not segmented, and on the bus as much again of incomplete ones; > 0.
    std::size_t max_queue_bytes = std::size_t{1} << 30U;
    UpdatePublisher::Config updates;
    bool exit_on_final = false;  ///< end when the final slice is segmented and published
    /// How long to stay after the end when nobody requests anything, seconds; < 0: until a stop
    /// signal, or 2 s when a stop signal was the end. Only when publishing.
    double linger_s = 2.0;
    std::chrono::milliseconds status_period{250};  ///< > 0

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// Opens the bus.
  /// @throws std::invalid_argument for an invalid config
  /// @throws std::runtime_error when the bus cannot be opened
  explicit SegmenterProcess(const Config& config);
  ~SegmenterProcess();

  /// Works until the end of the log, the final slice (Config::exit_on_final) or a stop signal;
  /// writes the maps, and lingers. Returns the exit status: 0, or 1 when a file is not written, an
  /// update was not sent, the log is damaged, or slices are missing at the end.
  /// @throws what makes going on impossible, after it has tried to write the maps
  int run();

 private:
  void keep(const CameraView& view);
  void receive();
  void segment();
  void watch();
  bool has_ended() const;
  void linger();
  bool nothing_is_queued() const;
  std::string problem() const;
  void publish_status_when_due();
  void publish_status();
  int report() const;

  Config config_;
  std::int64_t session_;
  PatientClock clock_;
  std::unique_ptr<Bus> bus_;  // null: nothing is received from it or published
  UpdatePublisher updates_;
  SliceQueue queue_;
  std::unique_ptr<ViewRecorder> views_;  // null: nobody can ask for them, and no map is saved
  QueryResponder queries_;
  SliceReceiver receiver_;
  SegmentationLoop loop_;

  std::exception_ptr failure_;  // of the segmenting thread; read when it has ended
  std::atomic<bool> is_segmenting_{true};
  std::string status_problem_;  // why the status was not published; empty: it was
  std::chrono::steady_clock::time_point next_status_{};
  bool is_lingering_ = false;
  std::unique_ptr<BusThread> bus_thread_;  // last: it uses the others
};

}  // namespace kintsugi::segmenter
