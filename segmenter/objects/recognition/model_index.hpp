#pragma once
// Which objects of the library look like a piece of surface.

#include <cstddef>
#include <memory>
#include <vector>

#include "segmenter/objects/recognition/view_descriptor.hpp"

namespace kintsugi::segmenter {

/// One view of an object.
struct IndexedView {
  std::size_t model = 0;  ///< index of the object
  ViewDescriptor descriptor;
};

struct ModelMatch {
  std::size_t model = 0;
  /// Of the nearest of its views, in standard deviations between views of one object: root of the
  /// mean over the elements of the descriptor that are compared.
  float distance = 0.0F;
};

/// Searches the views of all objects (FLANN). The elements of descriptors are scaled by how much
/// they differ between views of one object, over all objects: what says little counts little. With
/// what has no colours, only size and shape are compared.
class ModelIndex {
 public:
  /// By ascending model.
  explicit ModelIndex(const std::vector<IndexedView>& views);
  ~ModelIndex();
  ModelIndex(ModelIndex&&) noexcept;
  ModelIndex& operator=(ModelIndex&&) noexcept;

  /// How far a descriptor that begins so is from the nearest view, at the least; as
  /// ModelMatch::distance. Infinite without views.
  [[nodiscard]] float least_distance(const SizeAndColors& beginning) const;

  /// The objects with the nearest views, nearest first: at most `count`, and none that is farther
  /// off than `distance`.
  [[nodiscard]] std::vector<ModelMatch> nearest(const ViewDescriptor& descriptor, std::size_t count,
                                                float distance) const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace kintsugi::segmenter
