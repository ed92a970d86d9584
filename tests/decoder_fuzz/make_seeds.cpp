// make_seeds FOLDER: FOLDER/<target>/<name> for every fuzzing target.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/decoder_fuzz/seeds.hpp"

namespace {

namespace fs = std::filesystem;
using namespace kintsugi::fuzzing;  // NOLINT(google-build-using-namespace)

void write(const fs::path& folder, const Seeds& seeds) {
  fs::create_directories(folder);
  for (const auto& [name, bytes] : seeds) {
    std::ofstream file(folder / name, std::ios::binary);
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  }
}

void write_all(const fs::path& folder) {
  write(folder / "message", message_seeds());
  write(folder / "signed_message", signed_message_seeds());
  for (const char* target : {"join", "log", "stream"}) write(folder / target, log_seeds());
  write(folder / "requests", request_seeds());
  write(folder / "stored_sessions", stored_session_seeds());
  write(folder / "rgbd_frame", rgbd_frame_seeds());
  write(folder / "image", image_seeds());
  write(folder / "cloud_file", cloud_file_seeds());
  write(folder / "ply", ply_seeds());
  write(folder / "point_file", point_file_seeds());
  write(folder / "saved_map", saved_map_seeds());
  write(folder / "object", object_seeds());
  write(folder / "views_file", views_file_seeds());
  write(folder / "oni_file", oni_seeds());
  write(folder / "recording_file", recording_file_seeds());
  for (const char* target : {"calibration", "folder_recording", "trajectory", "recording_uri"}) {
    write(folder / target, text_seeds(target));
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::invalid_argument("expected one argument: the folder to write to");
    write_all(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "make_seeds: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
