// kintsugi-objects merge

#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "segmenter/objects/library/library_lock.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/objects/teaching/refine.hpp"
#include "segmenter/tools/objects/command.hpp"
#include "segmenter/tools/objects/object_text.hpp"

namespace kintsugi::segmenter {
namespace {

struct MergeOptions {
  std::filesystem::path library;
  std::string name;
  std::string other;
};

int merge(const MergeOptions& options) {
  if (options.name == options.other) {
    throw std::runtime_error("'" + options.name + "' cannot be merged into itself");
  }
  if (!std::filesystem::exists(options.library)) {
    throw std::runtime_error(options.library.string() + ": there is no such library");
  }
  const LibraryLock lock(options.library);
  const ObjectLibrary library = ObjectLibrary::read(options.library);
  const KnownObject& known = require_object(library, options.name);
  const KnownObject& other = require_object(library, options.other);
  Refinement refinement;
  try {
    refinement = refined(known, other);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("'" + options.other + "' " + error.what());
  }
  write_object(refinement.object, options.library);
  remove_object(options.other, options.library);
  std::cout << summary_text(refinement.object) << "; " << refinement.num_added
            << " points are new\n"
            << options.other << ": is " << options.name << " now\n";
  return 0;
}

}  // namespace

void add_merge_command(CLI::App& app, ObjectsAction& action) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App& command =
      *app.add_subcommand("merge", "makes one object of two that are the same: the first name stays");
  command.add_option("NAME", options->name, "of the object that stays")->required();
  command.add_option("OTHER", options->other, "of the object that becomes part of it")->required();
  add_library_option(command, options->library);
  command.callback([options, &action] { action = [options] { return merge(*options); }; });
}

}  // namespace kintsugi::segmenter
