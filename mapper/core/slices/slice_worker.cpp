#include "mapper/core/slices/slice_worker.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/stopwatch.hpp"
#include "lcmtypes/base/thread_priority.hpp"
#include "mapper/core/volume/tsdf_block_pool.hpp"

namespace kintsugi::mapper {
namespace {

/// With those around it, which are copies where they stay in the volume.
std::size_t num_blocks_held(const DetachedBlocks& blocks) {
  return blocks.coords.size() + blocks.apron_coords.size();
}

CloudSlice header_of(SliceKind kind, float resolution_m, const SliceCamera& camera) {
  CloudSlice header;
  header.utime = camera.utime;
  header.part = camera.at.place.part;
  header.kind = kind;
  header.resolution_m = resolution_m;
  header.X_WC = camera.X_WC;
  return header;
}

std::vector<PatchRun> no_patch(std::size_t num_points, const CloudSlice& header) {
  return {{.num_points = num_points, .patch = kNoPatch, .part = header.part}};
}

}  // namespace

void SliceWorker::Config::validate() const {
  extractor.validate();
  check_range<std::size_t>("max_queued_blocks", max_queued_blocks, 1, TsdfBlockPool::kMaxBlocks);
}

SliceWorker::SliceWorker(const Config& config)
    : config_((config.validate(), config)),
      extractor_(config.extractor),
      mesh_extractor_({.weight_threshold = config.extractor.weight_threshold,
                       .max_step_vox = config.extractor.max_step_vox}),
      patches_(config.tiles
                   ? std::optional<PatchMaker>(std::in_place, *config.tiles, config.common_surface)
                   : std::nullopt),
      thread_([this] { run(); }) {}

SliceWorker::~SliceWorker() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  work_.notify_all();
  thread_.join();
}

void SliceWorker::submit(DetachedBlocks blocks, const SliceCamera& camera) {
  Job job;
  job.header = header_of(blocks.kind, blocks.resolution_m, camera);
  job.camera = camera;
  job.blocks = std::move(blocks);
  enqueue(std::move(job));
}

void SliceWorker::submit(std::shared_future<DetachedBlocks> blocks, const SliceCamera& camera) {
  Job job;
  job.camera = camera;
  job.coming = std::move(blocks);
  enqueue(std::move(job));
}

void SliceWorker::submit(PatchBatch batch, DetachedBlocks in_volume, const SliceCamera& camera) {
  Job job;
  job.header = header_of(in_volume.kind, in_volume.resolution_m, camera);
  job.camera = camera;
  job.blocks = std::move(in_volume);
  job.batch = std::move(batch);
  enqueue(std::move(job));
}

void SliceWorker::submit(MapDeformation deformation, const SliceCamera& camera,
                         float resolution_m) {
  Job job;
  job.header = header_of(SliceKind::kCorrection, resolution_m, camera);
  job.camera = camera;
  job.deformation = std::move(deformation);
  enqueue(std::move(job));
}

void SliceWorker::submit(std::vector<TileVisit> returned, const SliceCamera& camera,
                         float resolution_m) {
  Job job;
  job.header = header_of(SliceKind::kPatch, resolution_m, camera);
  job.camera = camera;
  job.returned = std::move(returned);
  enqueue(std::move(job));
}

void SliceWorker::submit(std::vector<GuestPatch> patches, const SliceCamera& camera,
                         float resolution_m) {
  Job job;
  job.header = header_of(SliceKind::kPatch, resolution_m, camera);
  job.camera = camera;
  job.of_guests = std::move(patches);
  enqueue(std::move(job));
}

void SliceWorker::enqueue(Job job) {
  std::unique_lock lock(mutex_);
  const std::size_t num_blocks = num_blocks_held(job.blocks);
  done_.wait(lock, [&] {
    return failure_ || num_blocks == 0 || queue_.empty() ||
           queued_blocks_ + num_blocks <= config_.max_queued_blocks;
  });
  if (failure_) std::rethrow_exception(failure_);
  queued_blocks_ += num_blocks;
  queue_.push_back(std::move(job));
  work_.notify_one();
}

std::vector<CloudSlice> SliceWorker::take_finished() {
  std::unique_lock lock(mutex_);
  return take(lock);
}

std::vector<CloudSlice> SliceWorker::drain() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return failure_ || queue_.empty(); });
  return take(lock);
}

double SliceWorker::busy_ms() const {
  const std::scoped_lock lock(mutex_);
  return busy_ms_;
}

std::vector<CloudSlice> SliceWorker::take(std::unique_lock<std::mutex>& /*held*/) {
  if (failure_) std::rethrow_exception(failure_);
  return std::exchange(finished_, {});
}

void SliceWorker::run() {
  lower_priority_of_thread();
  std::unique_lock lock(mutex_);
  while (true) {
    work_.wait(lock, [this] { return stop_ || !queue_.empty(); });
    if (stop_) return;
    Job& job = queue_.front();  // stays valid: other threads only append
    lock.unlock();
    if (job.coming.valid()) job.coming.wait();
    const Stopwatch stopwatch;
    std::exception_ptr failure;
    std::vector<CloudSlice> slices;
    try {
      slices = work_on(job);
    } catch (...) {
      failure = std::current_exception();
    }
    const double elapsed_ms = stopwatch.elapsed_ms();
    lock.lock();
    busy_ms_ += elapsed_ms;
    failure_ = failure;
    std::ranges::move(slices, std::back_inserter(finished_));
    queued_blocks_ -= num_blocks_held(job.blocks);
    queue_.pop_front();
    done_.notify_all();
    if (failure_) return;
  }
}

std::vector<CloudSlice> SliceWorker::work_on(Job& job) {
  if (job.deformation) {
    return patches_.value().correct(*job.deformation, job.header, job.camera.at.place.X_WU);
  }
  if (!job.of_guests.empty()) {
    return patches_.value().take_in(std::move(job.of_guests), job.header);
  }
  if (!job.returned.empty())
    return patches_.value().reopen(job.returned, job.header, job.camera.at);
  const DetachedBlocks& blocks = job.coming.valid() ? job.coming.get() : job.blocks;
  if (job.coming.valid()) job.header = header_of(blocks.kind, blocks.resolution_m, job.camera);
  ExtractedSurface surface = extractor_.extract_blocks(blocks);
  if (job.batch) return patches_.value().make(*job.batch, surface, job.header);
  const std::vector<PatchRun> runs = patches_ ? patches_->keep(surface, job.camera.at)
                                              : no_patch(surface.points_W.size(), job.header);
  if (config_.on_points) config_.on_points(surface.points_W, runs);
  if (config_.on_mesh) {
    const MeshPiece piece = mesh_extractor_.extract(blocks);
    config_.on_mesh(piece, patches_ ? patches_->patches_of(piece, job.header.resolution_m)
                                    : no_patch(piece.vertices.size(), job.header));
  }
  return slices_of_left(job, std::move(surface));
}

std::vector<CloudSlice> SliceWorker::slices_of_left(const Job& job, ExtractedSurface surface) {
  if (patches_) {
    return job.header.kind == SliceKind::kFinal ? patches_->finish(job.header)
                                                : std::vector<CloudSlice>();
  }
  CloudSlice slice = job.header;
  slice.id = next_id_++;
  slice.points_W = std::move(surface.points_W);
  return {std::move(slice)};
}

}  // namespace kintsugi::mapper
