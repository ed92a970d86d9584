#pragma once
// The flags of programs that read a cloud from a file.

#include "segmenter/io/cloud_input.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

/// --resolution, --normals-k, --average-normals, --viewpoint and --unit, into `config`, whose
/// values are the defaults.
void add_cloud_options(CLI::App& app, CloudInputConfig& config);

}  // namespace kintsugi::segmenter
