// kintsugi-objects teach

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/objects/library/library_lock.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_name.hpp"
#include "segmenter/objects/recognition/flat_patch.hpp"
#include "segmenter/objects/teaching/refine.hpp"
#include "segmenter/objects/teaching/teach.hpp"
#include "segmenter/tools/objects/command.hpp"
#include "segmenter/tools/objects/map_difference.hpp"
#include "segmenter/tools/objects/object_text.hpp"
#include "segmenter/tools/objects/taught_map.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;

struct TeachOptions {
  fs::path library;
  fs::path map;
  std::vector<std::uint32_t> ids;
  fs::path difference;
  std::optional<std::int64_t> change;
  std::string name;
  bool replace = false;
};

std::int64_t now_s() { return std::time(nullptr); }

/// What the object in `folder` becomes by this lesson; errors say how to teach it nevertheless.
Refinement refined_with_hint(const fs::path& folder, const KnownObject& lesson) {
  try {
    const KnownObject known = read_object(folder);
    try {
      return refined(known, lesson);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(std::string("what is taught ") + error.what());
    }
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string(error.what()) +
                             "; --replace forgets what was known, another --name makes another "
                             "object");
  }
}

/// What has not more than that is seldom recognised (Placement::is_distinct).
void warn_of_flat_patch(const ObjectModel& model) {
  if (!is_flat_patch(SurfaceMoments(thinned(model.points_O, model.resolution_m)))) return;
  spdlog::warn(
      "{} is one flat patch of one colour, as many things have it: it will hardly be found. Teach "
      "its other sides, too: more segments in --ids, or the same --name where they are seen",
      model.name);
}

/// Writes the object, or what it adds to the one of that name, which the caller has locked.
void learn(const KnownObject& lesson, const TeachOptions& options) {
  const fs::path folder = options.library / lesson.model.name;
  if (options.replace || !fs::exists(fs::symlink_status(folder))) {
    write_object(lesson, options.library);
    std::cout << summary_text(lesson) << '\n';
    warn_of_flat_patch(lesson.model);
    return;
  }
  const Refinement refinement = refined_with_hint(folder, lesson);
  write_object(refinement.object, options.library);
  std::cout << summary_text(refinement) << '\n';
  warn_of_flat_patch(refinement.object.model);
}

void teach_from_map(const TeachOptions& options) {
  const ObservedMap map = read_taught_map(options.map);
  const TaughtSurface surface = surface_of_segments(map, options.ids);
  const KnownObject lesson =
      taught_object(options.name, map, points_of(map, surface), surface, now_s());
  const LibraryLock lock(options.library);
  learn(lesson, options);
}

/// "new_3", or "new_3_2" where that is taken and not to be replaced.
std::string name_of(const ShownChange& change, const TeachOptions& options) {
  if (!options.name.empty()) return options.name;
  const fs::path& library = options.library;
  std::string name = change.kind + "_" + std::to_string(change.id);
  if (options.replace) return name;
  std::string free = name;
  for (int i = 2; fs::exists(fs::symlink_status(library / free)); ++i) {
    free = name + "_" + std::to_string(i);
  }
  return free;
}

/// The points of the change may lie where the maps were aligned, and not as in its own map; then
/// the segments tell which they are.
TaughtSurface surface_of(const ShownChange& change, const ObservedMap& map) {
  TaughtSurface surface = surface_at(map, change.points_W);
  if (2 * surface.indices.size() < change.points_W.size() && !change.segment_ids.empty()) {
    return surface_of_segments(map, change.segment_ids);
  }
  if (!change.segment_ids.empty()) surface.segment_ids = change.segment_ids;
  return surface;
}

/// Of all changes, before anything is taught.
std::map<fs::path, ObservedMap> maps_of(const std::vector<ShownChange>& changes) {
  std::map<fs::path, ObservedMap> maps;
  for (const ShownChange& change : changes) {
    if (!maps.contains(change.map)) {
      if (!fs::exists(change.map)) {
        throw std::runtime_error(change.map.string() +
                                 ": there is no such map; if it was on the bus when it was " +
                                 "compared, --map tells where it was saved");
      }
      maps[change.map] = read_taught_map(change.map);
    }
    const std::int64_t session = maps[change.map].map_session;  // a PLY file tells none
    if (session != 0 && change.map_session != 0 && session != change.map_session) {
      throw std::runtime_error(change.map.string() + ": is of session " + std::to_string(session) +
                               ", and the map that was compared is of session " +
                               std::to_string(change.map_session));
    }
  }
  return maps;
}

void teach_from_difference(const TeachOptions& options) {
  const std::vector<ShownChange> changes =
      read_changes(options.difference, options.change, options.map);
  if (!options.name.empty() && changes.size() > 1) {
    throw std::runtime_error(
        options.difference.string() + ": has " + std::to_string(changes.size()) +
        " changes: choose one with --change to give it the name '" + options.name + "'");
  }
  if (changes.empty()) {
    spdlog::warn("{}: nothing is new, gone or moved", options.difference.string());
  }
  const std::map<fs::path, ObservedMap> maps = maps_of(changes);
  const LibraryLock lock(options.library);
  std::size_t num_taught = 0;
  for (const ShownChange& change : changes) {
    const ObservedMap& map = maps.at(change.map);
    const std::string name = name_of(change, options);
    std::optional<KnownObject> lesson;
    try {
      lesson = taught_object(name, map, change.points_W, surface_of(change, map), now_s());
    } catch (const std::runtime_error& error) {
      // One that is too small does not keep the others from being taught.
      if (changes.size() == 1) throw;
      spdlog::warn("change {} ({}): {}", change.id, change.kind, error.what());
      continue;
    }
    learn(*lesson, options);
    ++num_taught;
  }
  if (num_taught == 0 && !changes.empty()) {
    throw std::runtime_error(options.difference.string() + ": none of its " +
                             std::to_string(changes.size()) + " changes could be taught");
  }
}

int teach(const TeachOptions& options) {
  if (options.map.empty() && options.difference.empty()) {
    throw std::runtime_error("give either --map with --ids and --name, or --from-diff");
  }
  if (!options.name.empty()) {
    if (const auto reason = reason_to_refuse_name(options.name)) throw std::runtime_error(*reason);
  }
  if (!options.difference.empty()) {
    teach_from_difference(options);
    return 0;
  }
  if (options.ids.empty())
    throw std::runtime_error("--map needs --ids: the segments of the object");
  if (options.name.empty()) throw std::runtime_error("--map needs --name: that of the object");
  teach_from_map(options);
  return 0;
}

}  // namespace

void add_teach_command(CLI::App& app, ObjectsAction& action) {
  const auto options = std::make_shared<TeachOptions>();
  CLI::App& command = *app.add_subcommand(
      "teach", "adds an object to the library, or refines the one of that name");
  CLI::Option* const map =
      command.add_option("--map", options->map,
                         "the map in which it is: a saved map (kintsugi-segmenter --save) or an "
                         "LCM log, with what the "
                         "camera saw, or a labelled PLY file; with --from-diff of a map on the "
                         "bus: where it was saved");
  add_log_trust_flags(command);
  CLI::Option* const ids =
      command
          .add_option("--ids", options->ids, "ID,...: the segments of that map that are the object")
          ->delimiter(',')
          ->needs(map);
  CLI::Option* const difference =
      command
          .add_option("--from-diff", options->difference,
                      "output of kintsugi-diff: teaches what is new, gone or moved")
          ->excludes(ids);
  command.add_option("--change", options->change, "of it only the change with this id")
      ->needs(difference);
  command.add_option("--name", options->name,
                     "of the object: letters, digits, '-', '_' (default with --from-diff: kind and "
                     "id of the change, as new_3, and new_3_2 where that is taken)");
  command.add_flag("--replace", options->replace,
                   "forget what was known of an object of that name");
  add_library_option(command, options->library);
  command.callback([options, &action] { action = [options] { return teach(*options); }; });
}

}  // namespace kintsugi::segmenter
