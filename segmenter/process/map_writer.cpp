#include "segmenter/process/map_writer.hpp"

#include <exception>

#include <spdlog/spdlog.h>

#include "segmenter/io/map_files.hpp"
#include "segmenter/io/saved_map.hpp"

namespace kintsugi::segmenter {
namespace {

void write_files(const MapSnapshot& map, const std::filesystem::path& folder,
                 const std::string& stem) {
  write_map_files(map, folder, stem);
  spdlog::info("wrote {}.ply and .json: {} slices, {} points, {} segments",
               (folder / stem).string(), map.state.slices.size(), map.state.points_W.size(),
               map.segments.size());
}

void save_state(const SegmentMapState& state, const std::filesystem::path& file) {
  if (file.has_parent_path()) {
    std::filesystem::create_directories(file.parent_path());
  }
  write_map_state(state, file);
  spdlog::info("saved {}: {} slices to go on with", file.string(), state.slices.size());
}

}  // namespace

void MapWriter::write(const SegmentMap& map, const std::string& stem) {
  if (const Snapshot snapshot = copy(map)) {
    put_files(snapshot, stem);
  }
}

void MapWriter::save(const SegmentMap& map) {
  if (config_.save_file.empty()) {
    return;
  }
  if (const Snapshot snapshot = copy(map)) {
    put_saved(snapshot);
  }
}

void MapWriter::write_and_save(const SegmentMap& map, const std::string& stem) {
  if (const Snapshot snapshot = copy(map)) {
    put_files(snapshot, stem);
    put_saved(snapshot);
  }
}

// Null when there is no memory for it.
MapWriter::Snapshot MapWriter::copy(const SegmentMap& map) {
  Snapshot snapshot;
  try_to("the map is not copied",
         [&] { snapshot = std::make_shared<const MapSnapshot>(take_snapshot(map)); });
  return snapshot;
}

void MapWriter::put_files(const Snapshot& map, const std::string& stem) {
  writer_.put(stem, [this, map, stem] {
    try_to("the map is not written as " + stem, [&] { write_files(*map, config_.folder, stem); });
  });
}

void MapWriter::put_saved(const Snapshot& map) {
  if (config_.save_file.empty()) {
    return;
  }
  writer_.put("", [this, map] {  // no stem is empty
    try_to("the map is not saved", [&] { save_state(map->state, config_.save_file); });
  });
}

template <class Action>
void MapWriter::try_to(const std::string& what, const Action& action) {
  std::string problem;
  try {
    action();
  } catch (const std::exception& error) {  // the map goes on, and is written again later
    problem = what + ": " + error.what();
    spdlog::error("{}", problem);
  }
  const std::lock_guard lock(mutex_);
  if (problem.empty()) {
    problems_.erase(what);
  } else {
    problems_[what] = problem;
  }
}

std::string MapWriter::problem() const {
  const std::lock_guard lock(mutex_);
  return problems_.empty() ? "" : problems_.begin()->second;
}

}  // namespace kintsugi::segmenter
