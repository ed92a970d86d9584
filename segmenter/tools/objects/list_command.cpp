// kintsugi-objects list

#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "lcmtypes/base/json_text.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/tools/objects/command.hpp"
#include "segmenter/tools/objects/object_text.hpp"

namespace kintsugi::segmenter {
namespace {

struct ListOptions {
  std::filesystem::path library;
  bool json = false;
};

int list(const ListOptions& options) {
  if (!std::filesystem::exists(options.library)) {
    throw std::runtime_error(options.library.string() +
                             ": there is no such library: kintsugi-objects teach makes it");
  }
  const ObjectLibrary library = ObjectLibrary::read(options.library);
  warn_of_refusals(library);
  if (!options.json) {
    std::cout << table_text(library);
    return 0;
  }
  nlohmann::ordered_json all;
  all["objects"] = nlohmann::ordered_json::array();
  for (const KnownObject& object : library.objects()) {
    auto json = nlohmann::ordered_json::parse(
        read_file_bytes(options.library / object.model.name / kObjectFile));
    json["views"] = object.model.views_O.size();
    json.erase("views_O");
    all["objects"].push_back(json);
  }
  all["refused"] = nlohmann::ordered_json::array();
  for (const RefusedObject& refused : library.refusals()) {
    all["refused"].push_back({{"name", refused.name}, {"reason", refused.reason}});
  }
  std::cout << json_text(all, 2) << '\n';
  return 0;
}

}  // namespace

void add_list_command(CLI::App& app, ObjectsAction& action) {
  const auto options = std::make_shared<ListOptions>();
  CLI::App& command = *app.add_subcommand("list", "prints the objects that are known");
  command.add_flag("--json", options->json, "print JSON: all but points and views");
  add_library_option(command, options->library);
  command.callback([options, &action] { action = [options] { return list(*options); }; });
}

}  // namespace kintsugi::segmenter
