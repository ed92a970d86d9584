#include "segmenter/tools/objects/command.hpp"

#include <CLI/CLI.hpp>

namespace kintsugi::segmenter {

void add_library_option(CLI::App& command, std::filesystem::path& library) {
  library = "objects";
  command.add_option("--library", library, "folder of the library")->capture_default_str();
}

}  // namespace kintsugi::segmenter
