#include "mapper/process/map_files.hpp"

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::mapper {

template <typename Writer>
MapFiles::Output<Writer>::Output(const std::string& path) : path(path) {
  if (!path.empty()) writer.emplace(path);
}

template <typename Writer>
void MapFiles::Output<Writer>::attempt(const std::function<void(Writer&)>& action) {
  if (!writer) return;
  try {
    action(*writer);
  } catch (const std::exception& error) {
    spdlog::error("{}: given up, mapping goes on: {}", path, error.what());
    writer.reset();
    failed = true;
  }
}

MapFiles::MapFiles(const std::string& cloud, const std::string& mesh)
    : cloud_(cloud), mesh_(mesh) {}

std::function<void(const std::vector<CloudPoint>&, const std::vector<PatchRun>&)>
MapFiles::points_sink() {
  if (!cloud_.writer) return {};
  return [this](const std::vector<CloudPoint>& points, const std::vector<PatchRun>& runs) {
    cloud_.attempt([&](CloudWriter& writer) { writer.append(points, runs); });
  };
}

std::function<void(const MeshPiece&, const std::vector<PatchRun>&)> MapFiles::mesh_sink() {
  if (!mesh_.writer) return {};
  return [this](const MeshPiece& piece, const std::vector<PatchRun>& runs) {
    mesh_.attempt([&](MeshWriter& writer) { writer.append(piece, runs); });
  };
}

void MapFiles::commit(const PlaceOfPatch& place_of) {
  cloud_.attempt([&](CloudWriter& writer) {
    for (const auto& [path, count] : writer.commit(place_of)) {
      spdlog::info("cloud of {} points in {}", count, path.string());
    }
  });
  mesh_.attempt([&](MeshWriter& writer) {
    for (const auto& [path, count] : writer.commit(place_of)) {
      spdlog::info("mesh of {} triangles in {}", count, path.string());
    }
  });
}

}  // namespace kintsugi::mapper
