// kintsugi-objects forget

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "segmenter/objects/library/library_lock.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/objects/library/object_name.hpp"
#include "segmenter/tools/objects/command.hpp"
#include "segmenter/tools/objects/object_text.hpp"

namespace kintsugi::segmenter {
namespace {

struct ForgetOptions {
  std::filesystem::path library;
  std::vector<std::string> names;
};

/// All of them are there, or none is removed. Damaged objects can be forgotten, too.
void require_all(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  const ObjectLibrary library = ObjectLibrary::read(folder);
  for (const std::string& name : names) {
    if (const auto reason = reason_to_refuse_name(name)) throw std::runtime_error(*reason);
    const bool is_refused = std::any_of(library.refusals().begin(), library.refusals().end(),
                                        [&](const RefusedObject& r) { return r.name == name; });
    if (!is_refused) require_object(library, name);
    if (!std::filesystem::is_directory(folder / name)) {
      throw std::runtime_error((folder / name).string() + ": is no folder of an object");
    }
  }
}

int forget(const ForgetOptions& options) {
  if (!std::filesystem::exists(options.library)) {
    throw std::runtime_error(options.library.string() + ": there is no such library");
  }
  const LibraryLock lock(options.library);
  std::vector<std::string> names = options.names;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  require_all(options.library, names);
  for (const std::string& name : names) {
    remove_object(name, options.library);
    std::cout << name << ": forgotten\n";
  }
  return 0;
}

}  // namespace

void add_forget_command(CLI::App& app, ObjectsAction& action) {
  const auto options = std::make_shared<ForgetOptions>();
  CLI::App& command = *app.add_subcommand("forget", "removes objects from the library");
  command.add_option("NAME", options->names, "of the objects")->required();
  add_library_option(command, options->library);
  command.callback([options, &action] { action = [options] { return forget(*options); }; });
}

}  // namespace kintsugi::segmenter
