#pragma once
// The segments of a PLY file in the format of the ScanNet data set.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace kintsugi::segmenter {

/// The parameters of ScanNet's own segmenter, which mean the same as ours.
struct ScanNetParameters {
  double k_thresh = 0.0;           ///< k of Felzenszwalb and Huttenlocher
  std::int64_t seg_min_verts = 0;  ///< segments of fewer points are joined to a neighbour
};

/// Writes ScanNet's *.segs.json:
///   {"params":{"kThresh":0.002,"segMinVerts":50},"sceneId":"...","segIndices":[1,1,3,0]}
/// @param parameters absent when unknown: "params" is then empty
/// @param segment_ids of each vertex of the PLY file, in its order; 0: in no segment
/// @throws std::system_error naming the file and the reason
void write_scannet_segments(const std::string& scene_id,
                            const std::optional<ScanNetParameters>& parameters,
                            std::span<const std::uint32_t> segment_ids,
                            const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
