#include "lcmtypes/base/command_line.hpp"

#include <algorithm>
#include <filesystem>
#include <istream>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/version.hpp"

namespace kintsugi {
namespace {

/// The number of characters to insert, to remove or to replace (Levenshtein's distance). A dash
/// equals an underscore.
std::size_t spelling_distance(const std::string& a, const std::string& b) {
  const auto dashed = [](char c) { return c == '_' ? '-' : c; };
  std::vector<std::size_t> row(b.size() + 1);  // of the beginning of a to each beginning of b
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (dashed(a[i]) == dashed(b[j]) ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, replaced}));
    }
  }
  return row.back();
}

/// The options of the program that a file may set, without their dashes.
std::vector<std::string> keys_of(const CLI::App& app) {
  std::vector<std::string> keys;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_configurable()) {
      keys.insert(keys.end(), option->get_lnames().begin(), option->get_lnames().end());
    }
  }
  for (const CLI::App* group : app.get_subcommands({})) {  // option groups are among them
    const std::vector<std::string> of_group = keys_of(*group);
    keys.insert(keys.end(), of_group.begin(), of_group.end());
  }
  return keys;
}

/// "unknown key 'KEY'", and which one was meant, if one is spelt alike.
std::string unknown_key(const std::string& key, const std::vector<std::string>& keys) {
  const auto is_nearer = [&key](const std::string& a, const std::string& b) {
    return spelling_distance(key, a) < spelling_distance(key, b);
  };
  std::string text = "unknown key '" + key + "'";
  const auto nearest = std::min_element(keys.begin(), keys.end(), is_nearer);
  const std::size_t is_alike = std::max<std::size_t>(1, key.size() / 3);
  if (nearest != keys.end() && spelling_distance(key, *nearest) <= is_alike) {
    text += " (did you mean '" + *nearest + "'?)";
  }
  return text;
}

/// Whether the item gives a list no values, as --print-config writes it.
bool is_empty_list(const CLI::ConfigItem& item, const CLI::App& app) {
  const CLI::Option* const option = app.get_option_no_throw("--" + item.fullname());
  return option != nullptr && option->get_expected_max() > 1 &&
         item.inputs == std::vector<std::string>{""};
}

/// CLI11's format of files. By itself CLI11 ignores keys that the program does not know, and takes
/// an empty list for one empty value.
class StrictConfig : public CLI::ConfigBase {
 public:
  StrictConfig(const CLI::App& app, const CLI::Option& file) : app_(app), file_(file) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    std::vector<CLI::ConfigItem> items = CLI::ConfigBase::from_config(input);
    const std::vector<std::string> keys = keys_of(app_);
    std::string unknown;
    for (const CLI::ConfigItem& item : items) {
      if (item.name == "++" || item.name == "--") continue;  // begin and end of a section
      const std::string key = item.fullname();
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      unknown += (unknown.empty() ? "" : ", ") + unknown_key(key, keys);
    }
    std::erase_if(items, [&](const CLI::ConfigItem& item) { return is_empty_list(item, app_); });
    if (unknown.empty()) return items;
    throw CLI::ConfigError(file_.results().back() + ": " + unknown +
                           "; --print-config prints every key");
  }

 private:
  const CLI::App& app_;
  const CLI::Option& file_;
};

}  // namespace

void add_version_flag(CLI::App& app) {
  app.set_version_flag(
      "--version",
      [&app] {
        return std::filesystem::path(app.get_name()).filename().string() + " " + version();
      },
      "Print the version and exit");
}

void add_config_flag(CLI::App& app, const std::string& help) {
  const CLI::Option* const file = app.set_config("--config", "", help);
  app.config_formatter(std::make_shared<StrictConfig>(app, *file));
}

}  // namespace kintsugi
