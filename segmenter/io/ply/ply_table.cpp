#include "segmenter/io/ply/ply_table.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "segmenter/io/ply/ply_body.hpp"
#include "segmenter/io/ply/ply_header.hpp"

namespace kintsugi::segmenter {
namespace {

static_assert(std::endian::native == std::endian::little, "records are kept as a file has them");

void add_fields(const PlyElement& vertex, PointTable& table) {
  table.place = "line " + std::to_string(vertex.line) + ": element 'vertex'";
  for (const PlyProperty& property : vertex.properties) {
    table.add_field(property.name, property.list_count.value_or(property.type),
                    property.list_count.has_value());
  }
}

void read_vertices(PlyBody& body, const PlyElement& vertex, PointTable& table) {
  body.check_count(vertex);
  table.reserve(static_cast<std::size_t>(vertex.count));
  std::vector<double> values;
  for (std::int64_t row = 0; row < vertex.count; ++row) {
    body.read_row(vertex, row, values);
    char* const record = table.append();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const PointField& field = table.fields()[i];
      write_scalar(values[i], field.type, record + field.offset);
    }
  }
}

std::string declaration(const PlyProperty& property) {
  const std::string type(name_of(property.type));
  if (!property.list_count) return type + " " + property.name;
  return "list " + std::string(name_of(*property.list_count)) + " " + type + " " + property.name;
}

OtherElement keep(PlyBody& body, const PlyElement& element) {
  OtherElement other{.name = element.name, .properties = {}, .count = element.count, .records = {}};
  for (const PlyProperty& property : element.properties) {
    other.properties.push_back(declaration(property));
  }
  body.pass(element, &other.records);
  return other;
}

}  // namespace

PointTable parse_ply_table(std::string_view bytes, const std::string& name, LabelUse labels,
                           OtherElements others) {
  PlyHeader header = parse_ply_header(bytes, name);
  const auto body = make_ply_body(bytes, header, name);
  PointTable table;
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      has_vertices = true;
      add_fields(element, table);
      find_roles(table, name, labels);  // before memory is taken for what cannot be used
      read_vertices(*body, element, table);
    } else if (others == OtherElements::kKeep) {
      table.other_elements.push_back(keep(*body, element));
    } else {
      body->pass(element, nullptr);
    }
  }
  if (!has_vertices) {
    throw std::runtime_error(name + ": the header declares no element 'vertex'");
  }
  body->expect_end();
  table.comments = std::move(header.comments);
  return table;
}

}  // namespace kintsugi::segmenter
