#pragma once
// What the subcommands of kintsugi-objects have in common: each has a file of its own with a
// function that adds it.

#include <filesystem>
#include <functional>

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

/// What the chosen subcommand does; returns the exit code, and throws when it fails.
using ObjectsAction = std::function<int()>;

/// Adds --library to a subcommand.
void add_library_option(CLI::App& command, std::filesystem::path& library);

/// Each adds its subcommand, which sets `action` when it is chosen. `action` must outlive `app`.
void add_teach_command(CLI::App& app, ObjectsAction& action);
void add_list_command(CLI::App& app, ObjectsAction& action);
void add_show_command(CLI::App& app, ObjectsAction& action);
void add_forget_command(CLI::App& app, ObjectsAction& action);
void add_merge_command(CLI::App& app, ObjectsAction& action);

}  // namespace kintsugi::segmenter
