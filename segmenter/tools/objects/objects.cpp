// kintsugi-objects: teaches objects, looks after the library of them, and finds them in maps.

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "segmenter/tools/objects/command.hpp"

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  return kintsugi::run_main(argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-objects"));
    spdlog::set_pattern("%^%l%$: %v");
    CLI::App app{
        "Teaches objects from segmented maps, looks after the library of them, and finds them in "
        "maps."};
    app.require_subcommand(1);
    app.set_help_all_flag("--help-all", "Print the help of all subcommands and exit");
    kintsugi::add_version_flag(app);
    ObjectsAction action;
    add_teach_command(app, action);
    add_list_command(app, action);
    add_show_command(app, action);
    add_forget_command(app, action);
    add_merge_command(app, action);
    add_detect_command(app, action);
    CLI11_PARSE(app, argc, argv);
    return action();
  });
}
