#pragma once
// Finds the objects of a library on the surface of a map.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "segmenter/objects/model/object_model.hpp"
#include "segmenter/objects/recognition/model_index.hpp"
#include "segmenter/objects/recognition/placement.hpp"
#include "segmenter/objects/recognition/pose_refinement.hpp"
#include "segmenter/objects/recognition/scene.hpp"

namespace kintsugi::segmenter {

/// An object where it was recognised.
struct Recognition {
  std::size_t model = 0;  ///< for ObjectRecognizer::model()
  Placement placement;
  std::int32_t searched_points = 0;  ///< Placement::points when it was searched for
};

class ObjectRecognizer {
 public:
  /// Prepares the models on all cores: some milliseconds of processor time for each.
  /// @param models in an order that is kept
  /// @param resolution_m voxel size of the map, > 0
  /// @param earlier one that has prepared some of the same models, which is not done again for the
  ///   same resolution; nullptr: there is none
  ObjectRecognizer(std::vector<ObjectModel> models, float resolution_m,
                   const ObjectRecognizer* earlier = nullptr);

  [[nodiscard]] float resolution_m() const { return resolution_m_; }
  [[nodiscard]] std::size_t num_models() const { return known_.size(); }
  [[nodiscard]] const ObjectModel& model(std::size_t model) const;
  /// How many models it has prepared itself.
  [[nodiscard]] std::size_t num_prepared() const { return num_prepared_; }
  /// Half the diagonal of the largest object; 0 without objects.
  [[nodiscard]] float largest_radius_m() const { return largest_radius_m_; }
  [[nodiscard]] float radius_m(std::size_t model) const { return prepared(model).radius_m; }

  /// The objects that the candidate could be surface of: some look alike until more is known of
  /// the light of the map. Each once.
  [[nodiscard]] std::vector<Recognition> recognize(const Candidate& candidate,
                                                   const Scene& scene) const;

  /// How unlike all objects the candidate is in size and colours, at the least: in standard
  /// deviations between views of one object (ModelIndex). Infinite without surface or objects, and
  /// for one flat patch of one colour, which is seldom recognised. It costs a small part of
  /// recognize().
  [[nodiscard]] float least_distance(const Candidate& candidate, const Scene& scene) const;

  /// The best place of one object on a part of the scene's surface, however good it is; nothing if
  /// there is none.
  [[nodiscard]] std::optional<Placement> place(std::size_t model, const Surface& part_W,
                                               const Scene& scene) const;

  /// An object that was there, as the scene shows it now, however little speaks for it. It costs a
  /// small part of a search.
  [[nodiscard]] Placement followed(std::size_t model, const Placement& last,
                                   const Scene& scene) const;

  /// The placement is good enough to say that the object is there.
  [[nodiscard]] bool is_recognized(const Placement& placement) const;

  /// The segments that have points in the box of an object there.
  [[nodiscard]] std::set<std::uint32_t> segments_around(std::size_t model,
                                                        const Placement& placement,
                                                        const Scene& scene) const;

 private:
  struct Known;
  using KnownModels = std::vector<std::shared_ptr<const Known>>;

  [[nodiscard]] const PreparedModel& prepared(std::size_t model) const;
  [[nodiscard]] bool has_choice() const;
  void refine(std::size_t model, const Scene& scene, Placement& best) const;

  float resolution_m_;
  KnownModels known_;
  std::size_t num_prepared_ = 0;
  float largest_radius_m_ = 0.0F;
  std::optional<ModelIndex> index_;
};

}  // namespace kintsugi::segmenter
