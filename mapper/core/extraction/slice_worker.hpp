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

/// Extracts numbered slices from blocks that left the volume, on a thread of its own, so that
/// tracking does not wait. With one thread and one queue, slices are finished in the order of
/// submission.
///
/// The thread has a low priority; it needs about a hundredth of a processor. submit() blocks only
/// while max_queued_blocks are waiting: memory stays bounded and no part of the map is lost, but a
/// live camera's frames are dropped meanwhile.
class SliceWorker {
 public:
  struct Config {
    SurfaceExtractor::Config extractor;
    /// Largest number of blocks in the queue, with those around the slices; a slice larger than
    /// this waits for an empty queue. 8,192 blocks are 32 MB, about three slices of a room.
    std::size_t max_queued_blocks = 8'192;
    /// Called with each piece of the mesh, in order, on the worker's thread; if empty, no mesh is
    /// made. Exceptions from it are treated like those from extraction.
    std::function<void(const MeshPiece&)> on_mesh;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit SliceWorker(const Config& config);
  /// Drops what is still queued.
  ~SliceWorker();
  SliceWorker(const SliceWorker&) = delete;
  SliceWorker& operator=(const SliceWorker&) = delete;

  /// Queues blocks that left at `utime` when the camera was at `X_WC`. The slice gets the next id.
  /// @throws what extraction of an earlier slice threw
  void submit(DetachedBlocks blocks, std::int64_t utime, const Pose& X_WC);

  /// Slices finished since the last call, without waiting.
  /// @throws what extraction of a slice threw
  std::vector<CloudSlice> take_finished();

  /// Waits for all submitted slices, then as take_finished().
  std::vector<CloudSlice> drain();

  /// Time spent extracting so far, milliseconds.
  double busy_ms() const;

 private:
  struct Job {
    DetachedBlocks blocks;
    CloudSlice slice;  ///< its points are not extracted yet
  };

  void run();
  void work_on(Job& job);
  std::vector<CloudSlice> take(std::unique_lock<std::mutex>& lock);

  const Config config_;
  const SurfaceExtractor extractor_;
  MeshExtractor mesh_extractor_;  ///< used by thread_ only
  std::int32_t next_id_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable work_;  ///< signals that a job was queued, or stop_
  std::condition_variable done_;  ///< signals that a job ended, or failed
  std::deque<Job> queue_;         ///< the front is being extracted
  std::size_t queued_blocks_ = 0;
  std::vector<CloudSlice> finished_;
  std::exception_ptr failure_;
  double busy_ms_ = 0.0;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
