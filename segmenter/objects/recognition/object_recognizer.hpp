#pragma once
// Finds the objects of a library on the surface of a map.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "segmenter/objects/model/object_model.hpp"
#include "segmenter/objects/recognition/model_index.hpp"
#include "segmenter/objects/recognition/placement.hpp"
#include "segmenter/objects/recognition/pose_refinement.hpp"
#include "segmenter/objects/recognition/scene.hpp"

namespace kintsugi::segmenter {

/// An object where it was recognised.
struct Recognition {
  std::size_t model = 0;  ///< index in ObjectRecognizer::models()
  Placement placement;
};

class ObjectRecognizer {
 public:
  /// @param models in an order that is kept
  /// @param resolution_m voxel size of the map, > 0
  ObjectRecognizer(std::vector<ObjectModel> models, float resolution_m);

  [[nodiscard]] const std::vector<ObjectModel>& models() const { return models_; }
  /// Half the diagonal of the largest object; 0 without objects.
  [[nodiscard]] float largest_radius_m() const { return largest_radius_m_; }
  [[nodiscard]] float radius_m(std::size_t model) const { return prepared(model).radius_m; }

  /// The objects that the candidate could be surface of: some look alike until more is known of
  /// the light of the map. Each once.
  [[nodiscard]] std::vector<Recognition> recognize(const Candidate& candidate,
                                                   const Scene& scene) const;

  /// The best place of one object on a part of the scene's surface, however good it is; nothing if
  /// there is none.
  [[nodiscard]] std::optional<Placement> place(std::size_t model, const Surface& part_W,
                                               const Scene& scene) const;

 private:
  [[nodiscard]] const PreparedModel& prepared(std::size_t model) const;

  std::vector<ObjectModel> models_;
  float resolution_m_;
  float largest_radius_m_ = 0.0F;
  std::vector<std::unique_ptr<const PreparedModel>> prepared_;
  std::optional<ModelIndex> index_;
};

/// The placement is good enough to say that the object is there.
bool is_recognized(const Placement& placement);

}  // namespace kintsugi::segmenter
