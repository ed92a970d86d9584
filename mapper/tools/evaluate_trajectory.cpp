// kintsugi-evaluate-trajectory: how far an estimated camera path is from the true one.

#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "mapper/core/trajectory_error.hpp"

namespace {

using namespace kintsugi::mapper;

Trajectory read_path(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": " + std::strerror(errno));
  return read_tum(in, file);
}

}  // namespace

int main(int argc, char** argv) {
  std::string estimate_file;
  std::string truth_file;
  CLI::App app{"Absolute trajectory error of a camera path, after rigid alignment."};
  app.add_option("ESTIMATE", estimate_file, "TUM format")->required();
  app.add_option("TRUTH", truth_file, "TUM format")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    const TrajectoryError error =
        absolute_trajectory_error(read_path(estimate_file), read_path(truth_file));
    std::cout << "pairs " << error.pairs << "  rmse_m " << error.rmse_m << "  median_m "
              << error.median_m << "  max_m " << error.max_m << '\n';
    return 0;
  } catch (const std::exception& error) {
    spdlog::error("kintsugi-evaluate-trajectory: {}", error.what());
    return 1;
  }
}
