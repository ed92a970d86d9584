#include "segmenter/output/map_writer.hpp"

#include <bit>
#include <exception>

#include "lcmtypes/base/file_sync.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/map/map_parts.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr char kSaved[] = "";  // the action that writes the saved map; no stem is empty

void save_state(const SegmentMapState& state, const MapWriter::Views& views,
                const std::filesystem::path& file) {
  make_folder(file.parent_path());
  if (views) write_views(*views, views_file_of(file));
  write_map_state(state, file);
  spdlog::info("saved {}: {} slices, {} views", file.string(), state.slices.size(),
               views ? views->views.size() : 0);
}

}  // namespace

void MapWriter::write(const SegmentMap& map, const std::string& stem) {
  put_files(copy(map), stem);
}

void MapWriter::save(const SegmentMap& map, const Views& views) {
  if (!config_.save_file.empty()) {
    put_saved(copy(map), views);
  }
}

void MapWriter::write_and_save(const SegmentMap& map, const std::string& stem, const Views& views) {
  const Snapshot snapshot = copy(map);
  put_files(snapshot, stem);
  put_saved(snapshot, views);
}

// The last owner of the snapshot returns its memory to spare_.
MapWriter::Snapshot MapWriter::copy(const SegmentMap& map) {
  std::unique_ptr<MapSnapshot> snapshot;
  {
    const std::lock_guard lock(spare_mutex_);
    snapshot = std::move(spare_);
  }
  if (!snapshot) {
    snapshot = std::make_unique<MapSnapshot>();
  }
  take_snapshot(map, *snapshot);
  return {snapshot.release(), [this](const MapSnapshot* written) {
            std::unique_ptr<MapSnapshot> spare(const_cast<MapSnapshot*>(written));
            const std::lock_guard lock(spare_mutex_);
            spare_.swap(spare);
          }};
}

void MapWriter::put_files(const Snapshot& map, const std::string& stem) {
  put(stem, [this, map, stem] { write_files(*map, stem); });
}

void MapWriter::put_saved(const Snapshot& map, const Views& views) {
  if (!config_.save_file.empty()) {
    put(kSaved, [this, map, views] { save_state(map->state, views, config_.save_file); });
  }
}

/// Afterwards there are files of those parts alone that the map has by now.
void MapWriter::write_files(const MapSnapshot& map, const std::string& stem) {
  const std::set<std::int32_t> parts = parts_of(map);
  std::set<std::int32_t>& written = written_parts_[stem];
  written.insert(parts.begin(), parts.end());  // before, because a part of them may be written
  write_map_files(map, config_.folder, stem);
  std::erase_if(written, [&](std::int32_t part) {
    if (parts.contains(part)) return false;
    remove_map_files(config_.folder, stem, part);
    return true;
  });
  spdlog::info("wrote {}.ply and .json: {} slices, {} points, {} segments",
               (config_.folder / stem).string(), map.state.slices.size(), map.state.points_W.size(),
               map.segments.size());
}

void MapWriter::put(const std::string& name, Action action) {
  std::int64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    number = ++newest_[name];
  }
  writer_.put(name,
              [this, name, number, action = std::move(action)] { attempt(name, number, action); });
}

void MapWriter::attempt(const std::string& name, std::int64_t number, const Action& action) {
  std::string why;
  try {
    action();
    return_free_memory();  // of what was written, and of what the map has replaced meanwhile
  } catch (const std::exception& error) {  // segmentation continues
    why = std::string("the map is not written: ") + error.what();
  }
  const std::lock_guard lock(mutex_);
  if (!why.empty()) {
    // Logs the 1st, 2nd, 4th, 8th ... failure: a full disk must not fill the log.
    if (std::has_single_bit(static_cast<std::uint64_t>(++num_failures_))) {
      spdlog::error("{}", why);
    }
    const bool is_newest = newest_[name] == number;
    failures_[name] = {is_newest ? action : Action{}, why};
    return;
  }
  failures_.erase(name);
  if (failures_.empty()) {
    num_failures_ = 0;
  }
}

void MapWriter::try_again() {
  std::map<std::string, Action> actions;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [name, failure] : failures_) {
      if (failure.action) actions[name] = std::exchange(failure.action, {});
    }
  }
  for (auto& [name, action] : actions) {
    put(name, std::move(action));
  }
}

std::string MapWriter::problem() const {
  const std::lock_guard lock(mutex_);
  return failures_.empty() ? "" : failures_.begin()->second.why;
}

}  // namespace kintsugi::segmenter
