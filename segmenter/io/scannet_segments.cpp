#include "segmenter/io/scannet_segments.hpp"

#include <ostream>

#include <nlohmann/json.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/json_text.hpp"

namespace kintsugi::segmenter {

void write_scannet_segments(const std::string& scene_id,
                            const std::optional<ScanNetParameters>& parameters,
                            std::span<const std::uint32_t> segment_ids,
                            const std::filesystem::path& path) {
  nlohmann::ordered_json params = nlohmann::ordered_json::object();
  if (parameters.has_value()) {
    params["kThresh"] = parameters->k_thresh;
    params["segMinVerts"] = parameters->seg_min_verts;
  }
  AtomicFile file(path);
  std::ostream& out = file.stream();
  // Written one by one: as JSON, the indices of millions of points would need much memory.
  out << "{\"params\":" << params.dump()
      << ",\"sceneId\":" << json_text(nlohmann::ordered_json(scene_id)) << ",\"segIndices\":[";
  const char* separator = "";
  for (const std::uint32_t id : segment_ids) {
    out << separator << id;
    separator = ",";
  }
  out << "]}\n";
  file.commit();
}

}  // namespace kintsugi::segmenter
