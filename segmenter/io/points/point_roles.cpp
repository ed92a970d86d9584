#include "segmenter/io/points/point_roles.hpp"

#include <stdexcept>
#include <string_view>

namespace kintsugi::segmenter {
namespace {

enum class Allowed { kReal, kInteger, kColor, kAny };

using Names = std::array<std::string_view, 3>;

class RoleFinder {
 public:
  RoleFinder(const PointTable& table, const std::string& name) : table_(table), name_(name) {}

  std::optional<std::size_t> find_one(std::string_view property, Allowed allowed) const {
    const auto index = table_.find(property);
    if (index) check_type(table_.fields()[*index], allowed);
    return index;
  }

  std::optional<PointRoles::Triple> find(const Names& names, Allowed allowed, bool required) const {
    PointRoles::Triple triple{};
    std::size_t num_found = 0;
    std::string missing;
    for (std::size_t i = 0; i < 3; ++i) {
      if (const auto index = find_one(names[i], allowed)) {
        triple[i] = *index;
        ++num_found;
      } else {
        missing += " '" + std::string(names[i]) + "'";
      }
    }
    if (num_found == 0 && !required) return std::nullopt;
    if (num_found != 3) fail("lacks property" + missing);
    return triple;
  }

  std::optional<PointRoles::Triple> find_color() const {
    constexpr std::array<Names, 3> kNames{{{"red", "green", "blue"},
                                           {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                           {"r", "g", "b"}}};
    for (const Names& names : kNames) {
      if (table_.find(names[0]) && table_.find(names[1]) && table_.find(names[2])) {
        return find(names, Allowed::kColor, false);
      }
    }
    return find(kNames[0], Allowed::kColor, false);  // none, or the error that names the missing
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": " + table_.place + " " + what);
  }

  void check_type(const PointField& field, Allowed allowed) const {
    if (field.is_list) fail("has a list as property '" + field.name + "', expected a scalar");
    const bool is_real = !is_integer(field.type);
    if (allowed == Allowed::kReal && !is_real) fail_in_type(field, "float or double");
    if (allowed == Allowed::kInteger && is_real) fail_in_type(field, "an integer type");
    if (allowed == Allowed::kColor && !is_real && field.type != ScalarType::kUint8 &&
        field.type != ScalarType::kUint16) {
      fail_in_type(field, "uchar, or float in 0..1, or ushort");
    }
  }

  [[noreturn]] void fail_in_type(const PointField& field, const std::string& expected) const {
    fail("has property '" + field.name + "' of type " + std::string(name_of(field.type)) +
         ", expected " + expected);
  }

  const PointTable& table_;
  const std::string& name_;
};

}  // namespace

PointRoles find_roles(const PointTable& table, const std::string& name, LabelUse labels) {
  const RoleFinder finder(table, name);
  PointRoles roles;
  roles.position = *finder.find({"x", "y", "z"}, Allowed::kReal, true);
  roles.normal = finder.find({"nx", "ny", "nz"}, Allowed::kReal, false);
  roles.color = finder.find_color();
  roles.weight = finder.find_one("weight", Allowed::kAny);
  roles.slice_id = finder.find_one("slice_id", Allowed::kInteger);
  if (labels == LabelUse::kIgnore) return roles;
  roles.segment_id = finder.find_one("segment_id", Allowed::kInteger);
  roles.instance_id = finder.find_one("instance_id", Allowed::kInteger);
  roles.in_volume = finder.find_one("in_volume", Allowed::kInteger);
  return roles;
}

}  // namespace kintsugi::segmenter
