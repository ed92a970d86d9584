#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/slices/common_surface.hpp"
#include "mapper/core/slices/patch_batch.hpp"
#include "mapper/core/slices/patch_maker.hpp"
#include "mapper/core/slices/tile.hpp"
#include "mapper/core/slices/tile_visit.hpp"
#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {

/// The camera when slices were made.
struct SliceCamera {
  std::int64_t utime = 0;
  Pose X_WC = Pose::Identity();
  SeenAt at = {};  ///< where it is
};

/// Extracts the surface of blocks and makes numbered slices of it, on a thread of its own, so that
/// tracking does not wait. With one thread and one queue, slices are finished in the order of
/// submission.
///
/// The thread has a low priority. Submitting blocks only while max_queued_blocks are waiting:
/// memory stays bounded and no part of the map is lost, but a live camera's frames are dropped
/// meanwhile.
class SliceWorker {
 public:
  struct Config {
    SurfaceExtractor::Config extractor;
    /// The slices are patches, one for each tile, and not one for what left at one time.
    std::optional<TileGrid> tiles;
    /// Of patches; see PatchMaker.
    std::optional<CommonSurface::Config> common_surface;
    /// Largest number of blocks in the queue, with those around the slices; a slice larger than
    /// this waits for an empty queue. 8,192 blocks are 32 MB, about three slices of a room.
    std::size_t max_queued_blocks = 8'192;
    /// Called with the points that have left the volume, in order, on the worker's thread, and the
    /// patches that they are of; may be empty. Exceptions from it
    /// are treated like those from extraction.
    std::function<void(const std::vector<CloudPoint>&, const std::vector<PatchRun>&)> on_points;
    /// The same with each piece of the mesh and its vertices; if empty, no mesh is made.
    std::function<void(const MeshPiece&, const std::vector<PatchRun>&)> on_mesh;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit SliceWorker(const Config& config);
  /// Drops what is still queued.
  ~SliceWorker();
  SliceWorker(const SliceWorker&) = delete;
  SliceWorker& operator=(const SliceWorker&) = delete;

  /// Queues blocks that left when the camera was there. Final blocks end the run.
  /// @throws what extraction of an earlier slice threw
  void submit(DetachedBlocks blocks, const SliceCamera& camera);

  /// The same of blocks that another thread is working on, of a volume that was emptied. This does
  /// not wait for room in the queue: they take no more memory than they did in the volume, and the
  /// next one of this size comes much later.
  /// @throws as above
  void submit(std::shared_future<DetachedBlocks> blocks, const SliceCamera& camera);

  /// Queues patches; `in_volume` are copies of those blocks of their tiles that are in the volume.
  /// @throws as above
  void submit(PatchBatch batch, DetachedBlocks in_volume, const SliceCamera& camera);

  /// Queues a correction of the patches; see PatchMaker::correct(). For patches only.
  /// @throws as above
  void submit(MapDeformation deformation, const SliceCamera& camera, float resolution_m);

  /// Queues the return of visits to the volume; see PatchMaker::reopen(). For patches only.
  /// @throws as above
  void submit(std::vector<TileVisit> returned, const SliceCamera& camera, float resolution_m);

  /// Queues patches of guests; see PatchMaker::take_in(). For patches only.
  /// @throws as above
  void submit(std::vector<GuestPatch> patches, const SliceCamera& camera, float resolution_m);

  /// Slices finished since the last call, without waiting.
  /// @throws what extraction of a slice threw
  std::vector<CloudSlice> take_finished();

  /// Waits for all submitted slices, then as take_finished().
  std::vector<CloudSlice> drain();

  /// See PatchMaker::place_of(); after drain().
  std::optional<PatchPlace> place_of_patch(int patch) const {
    return patches_.value().place_of(patch);
  }

  /// Time spent extracting so far, milliseconds.
  double busy_ms() const;

 private:
  struct Job {
    DetachedBlocks blocks;
    std::shared_future<DetachedBlocks> coming;  ///< if valid, instead of `blocks`
    std::optional<PatchBatch> batch;            ///< none: the blocks have left
    std::optional<MapDeformation> deformation;  ///< there are no blocks
    std::vector<TileVisit> returned;            ///< if there are any, there are no blocks
    std::vector<GuestPatch> of_guests;          ///< the same
    SliceCamera camera;
    CloudSlice header;  ///< of its slices
  };

  void enqueue(Job job);
  void run();
  std::vector<CloudSlice> work_on(Job& job);
  std::vector<CloudSlice> slices_of_left(const Job& job, ExtractedSurface surface);
  std::vector<CloudSlice> take(std::unique_lock<std::mutex>& lock);

  const Config config_;
  const SurfaceExtractor extractor_;
  // Used by thread_ only:
  MeshExtractor mesh_extractor_;
  std::optional<PatchMaker> patches_;
  std::int32_t next_id_ = 0;  ///< of slices that are no patches

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
