#include "segmenter/objects/process/map_detection.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "segmenter/objects/process/cpu_budget.hpp"

namespace kintsugi::segmenter {

namespace {

// As large as objects: then what is around one is in few pieces.
constexpr float kPiece_m = 0.5F;

struct Piece {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;
};

void add_in_pieces(const ObservedMap& map, Detector& detector) {
  std::map<std::array<int, 3>, Piece> pieces;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    const CloudPoint& p = map.points_W[i];
    const auto cell = [](float x) { return static_cast<int>(std::floor(x / kPiece_m)); };
    Piece& piece = pieces[{cell(p.x), cell(p.y), cell(p.z)}];
    piece.points_W.push_back(p);
    piece.segment_ids.push_back(map.segment_ids[i]);
  }
  std::int32_t id = 0;
  for (auto& [cell, piece] : pieces) {
    auto points_W = std::make_shared<const std::vector<CloudPoint>>(std::move(piece.points_W));
    detector.set_piece(id++, std::move(points_W), std::move(piece.segment_ids), 0);
  }
}

}  // namespace

std::vector<ObjectModel> models_of(const ObjectLibrary& library) {
  std::vector<ObjectModel> models;
  models.reserve(library.objects().size());
  for (const KnownObject& object : library.objects()) models.push_back(object.model);
  return models;
}

MapDetection detect_in(const ObservedMap& map, const ObjectLibrary& library) {
  MapDetection found;
  const double start_s = CpuBudget::cpu_s();
  found.detector = std::make_unique<Detector>(models_of(library), map.resolution_m);
  const double prepared_s = CpuBudget::cpu_s();
  Detector& detector = *found.detector;
  add_in_pieces(map, detector);
  detector.examine_all();
  found.cost.num_segments = detector.num_waiting();
  while (detector.num_waiting() > 0) detector.examine_next();
  found.cost.prepare_s = prepared_s - start_s;
  found.cost.examine_s = CpuBudget::cpu_s() - prepared_s;
  return found;
}

}  // namespace kintsugi::segmenter
