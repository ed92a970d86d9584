// kintsugi-objects show

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/tools/objects/command.hpp"
#include "segmenter/tools/objects/model_picture.hpp"
#include "segmenter/tools/objects/object_text.hpp"

namespace kintsugi::segmenter {
namespace {

struct ShowOptions {
  std::filesystem::path library;
  std::string name;
  bool json = false;
  std::filesystem::path png;
};

int show(const ShowOptions& options) {
  const ObjectLibrary library = ObjectLibrary::read(options.library);
  const KnownObject& object = require_object(library, options.name);
  if (!options.png.empty()) write_model_picture(object.model, options.png);
  if (options.json) {
    std::cout << read_file_bytes(options.library / options.name / kObjectFile);
  } else {
    std::cout << details_text(object);
  }
  return 0;
}

}  // namespace

void add_show_command(CLI::App& app, ObjectsAction& action) {
  const auto options = std::make_shared<ShowOptions>();
  CLI::App& command = *app.add_subcommand("show", "prints what is known of an object");
  command.add_option("NAME", options->name, "of the object")->required();
  command.add_flag("--json", options->json, "print its object.json");
  command.add_option("--png", options->png, "write a picture of its model from three sides");
  add_library_option(command, options->library);
  command.callback([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace kintsugi::segmenter
