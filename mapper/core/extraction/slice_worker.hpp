#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {

/// Turns blocks that left the volume into numbered slices, on a thread of its own so that tracking
/// goes on. One thread and one queue: slices come out in the order in which blocks went in.
///
/// The thread has a low priority and gets what tracking leaves of the processor; it needs about a
/// hundredth of it. Only when max_queued_blocks wait does submit() wait for it: nothing of the map
/// is lost then and memory stays bounded, while a camera's frames are dropped meanwhile.
class SliceWorker {
 public:
  struct Config {
    SurfaceExtractor::Config extractor;
    /// Blocks that may wait or be worked on; a slice larger than this waits for an empty queue.
    /// 65,536 are 256 MB, some fifty slices of a room.
    std::size_t max_queued_blocks = 65'536;
    /// Gets the mesh, piece by piece and in order, on the worker's thread; none is made if empty.
    /// What it throws comes out as what extraction throws does.
    std::function<void(const MeshPiece&)> on_mesh;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit SliceWorker(const Config& config);
  /// What is still queued is dropped.
  ~SliceWorker();
  SliceWorker(const SliceWorker&) = delete;
  SliceWorker& operator=(const SliceWorker&) = delete;

  /// Queues blocks that left at `utime` when the camera was at `X_WC`. The slice gets the next id.
  /// @throws what extraction threw before
  void submit(DetachedBlocks blocks, std::int64_t utime, const Pose& X_WC);

  /// Slices finished since the last call, without waiting.
  /// @throws what extraction threw
  std::vector<CloudSlice> take_finished();

  /// Waits for everything submitted, then as take_finished().
  std::vector<CloudSlice> drain();

  /// Time spent extracting so far, milliseconds.
  double busy_ms() const;

 private:
  struct Job {
    DetachedBlocks blocks;
    CloudSlice slice;  ///< all but its points
  };

  void run();
  void work_on(Job& job);
  std::vector<CloudSlice> take(std::unique_lock<std::mutex>& lock);

  const Config config_;
  const SurfaceExtractor extractor_;
  MeshExtractor mesh_extractor_;  ///< the thread's own
  std::int32_t next_id_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable work_;  ///< something was queued, or stop
  std::condition_variable done_;  ///< something was extracted, or extraction failed
  std::deque<Job> queue_;         ///< the front is being extracted
  std::size_t queued_blocks_ = 0;
  std::vector<CloudSlice> finished_;
  std::exception_ptr failure_;
  double busy_ms_ = 0.0;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
