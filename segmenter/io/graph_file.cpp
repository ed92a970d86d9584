#include "segmenter/io/graph_file.hpp"

#include <ostream>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/number_text.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr char kHead[] = R"(<?xml version="1.0" encoding="UTF-8"?>
<graphml xmlns="http://graphml.graphdrawing.org/xmlns">
 <key id="points" for="node" attr.name="points" attr.type="long"/>
 <key id="area" for="node" attr.name="area" attr.type="double"/>
 <key id="x" for="node" attr.name="x" attr.type="double"/>
 <key id="y" for="node" attr.name="y" attr.type="double"/>
 <key id="z" for="node" attr.name="z" attr.type="double"/>
 <key id="planar" for="node" attr.name="planar" attr.type="boolean"/>
 <key id="pairs" for="edge" attr.name="pairs" attr.type="long"/>
 <graph id="segments" edgedefault="undirected">
)";

template <class Value>
void write_data(std::ostream& out, const char* key, const Value& value) {
  out << "<data key=\"" << key << "\">" << value << "</data>";
}

void write_node(std::ostream& out, const SegmentDescription& segment) {
  const SegmentStatistics& s = segment.statistics;
  out << "  <node id=\"" << s.segment_id << "\">";
  write_data(out, "points", s.num_points);
  write_data(out, "area", shortest_text(s.area_m2));
  write_data(out, "x", shortest_text(s.centroid_W[0]));
  write_data(out, "y", shortest_text(s.centroid_W[1]));
  write_data(out, "z", shortest_text(s.centroid_W[2]));
  write_data(out, "planar", segment.shape.is_planar ? "true" : "false");
  out << "</node>\n";
}

}  // namespace

void write_graph(const AdjacencyGraph& graph, std::span<const SegmentDescription> segments,
                 const std::filesystem::path& path) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << kHead;
  for (const SegmentDescription& segment : segments) write_node(out, segment);
  for (const AdjacencyEdge& edge : graph.edges) {
    out << "  <edge source=\"" << edge.a << "\" target=\"" << edge.b << "\">";
    write_data(out, "pairs", edge.num_pairs);
    out << "</edge>\n";
  }
  out << " </graph>\n</graphml>\n";
  file.commit();
}

}  // namespace kintsugi::segmenter
