// kintsugi-render-scene: writes a synthetic scene as a folder of images, which folder:// plays.

#include <cstdio>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/synthetic/render/folder_writer.hpp"
#include "mapper/synthetic/render/ground_truth.hpp"
#include "mapper/tools/progress.hpp"

namespace {

using kintsugi::mapper::RecordingUri;
using kintsugi::synthetic::FolderWriter;
using kintsugi::synthetic::FrameRange;
using kintsugi::synthetic::Sequence;
using kintsugi::synthetic::write_ground_truth;

void render(const std::string& address, const std::string& folder, const std::string& frames) {
  const auto uri = kintsugi::mapper::parse_recording_uri(address);
  if (!uri || uri->scheme != RecordingUri::Scheme::kSynthetic) {
    throw std::invalid_argument("'" + address + "': expected synthetic://NAME?key=value&...");
  }
  const auto config = Sequence::Config::parse(uri->path, uri->options);
  Sequence sequence(config);
  if (!config.ground_truth.empty()) write_ground_truth(sequence, config.ground_truth);
  const FrameRange range = FrameRange::parse(frames, sequence.num_frames());
  FolderWriter writer(sequence, folder);
  {
    kintsugi::mapper::Progress progress;
    for (int frame = range.first; frame < range.end; frame += range.step) {
      writer.write_frame(frame);
      progress.show(frame + 1, range.end);
    }
  }
  writer.finish();
  std::fprintf(stderr, "wrote %s\n", folder.c_str());
}

std::string scenes_and_options() {
  std::string text = "Scenes:";
  for (const std::string& name : kintsugi::synthetic::scene_names()) text += " " + name;
  return text + "\nOptions: " + Sequence::Config::known_options();
}

}  // namespace

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    CLI::App app(
        "Renders a synthetic scene into a folder in TUM layout: depth, rgb, true normals, "
        "instances and poses.");
    std::string address;
    std::string folder;
    std::string frames;
    app.add_option("scene", address, "synthetic://NAME?key=value&..., see below")->required();
    app.add_option("--out", folder, "folder to write to")->required();
    app.add_option("--frames", frames, "first:end:step, all by default");
    app.footer(scenes_and_options());
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    render(address, folder, frames);
    return 0;
  });
}
