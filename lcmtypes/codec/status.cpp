// The statuses of the processes. Their fields are listed once, in statuses.hpp.

#include <string>
#include <type_traits>

#include <kintsugi/detector_status_t.hpp>
#include <kintsugi/mapper_status_t.hpp>
#include <kintsugi/segmenter_status_t.hpp>
#include <kintsugi/viewer_status_t.hpp>

#include "lcmtypes/base/member_count.hpp"
#include "lcmtypes/codec/small.hpp"

namespace kintsugi {
namespace codec {
namespace {

template <class Status>
constexpr std::size_t num_listed() {
  std::size_t count = 0;
  Status::visit_fields([&count](const StatusField&) { ++count; });
  return count;
}

template <class Status>
int num_strings() {
  int count = 0;
  const Status status;
  Status::visit_fields(
      [&count](const StatusField&, const auto& value) {
        count += std::is_same_v<decltype(value), const std::string&> ? 1 : 0;
      },
      status);
  return count;
}

template <class To, class From>
To converted(const From& value) {
  // LCM's boolean is an int8_t of any value.
  if constexpr (std::is_same_v<To, bool>) return value != 0;
  return static_cast<To>(value);
}

void check_value(const Check& /*check*/, const StatusField& /*field*/, bool /*value*/) {}
void check_value(const Check& check, const StatusField& field, double value) {
  check.finite(field.name, value);
}
void check_value(const Check& check, const StatusField& field, const std::string& value) {
  check.text(field.name, value);
}
void check_value(const Check& check, const StatusField& /*field*/, TrackingState value) {
  check_state(check, value);
}
void check_value(const Check& check, const StatusField& field, std::int64_t value) {
  if (field.highest != kNoUpperBound) {
    check.range(field.name, value, field.lowest, field.highest);
  } else if (value < field.lowest) {
    check.fail(field.name, value, ">= " + std::to_string(field.lowest));
  }
}
void check_value(const Check& check, const StatusField& field, std::int32_t value) {
  check_value(check, field, std::int64_t{value});
}

template <class Status, class Wire>
struct SmallStatus : Copied<Status, Wire> {
  static_assert(num_listed<Status>() == num_members<Status>(),
                "visit_fields() does not list every member of the struct");
  static_assert(num_listed<Status>() + 1 == num_members<Wire>(),  // it has a checksum, too
                "visit_fields() does not list every field of the .lcm file");
  inline static const int kNumStrings = num_strings<Status>();

  template <class From, class To>
  static void copy(const From& from, To& to) {
    Status::visit_fields(
        [](const StatusField&, const auto& value, auto& copied) {
          copied = converted<std::remove_reference_t<decltype(copied)>>(value);
        },
        from, to);
  }
  static void check(const Check& check, const Status& status) {
    Status::visit_fields(
        [&check](const StatusField& field, const auto& value) { check_value(check, field, value); },
        status);
  }
};

}  // namespace

template <>
struct Small<MapperStatus> : SmallStatus<MapperStatus, mapper_status_t> {};
template <>
struct Small<SegmenterStatus> : SmallStatus<SegmenterStatus, segmenter_status_t> {};
template <>
struct Small<ViewerStatus> : SmallStatus<ViewerStatus, viewer_status_t> {};
template <>
struct Small<DetectorStatus> : SmallStatus<DetectorStatus, detector_status_t> {};

}  // namespace codec

template Bytes encode(const MapperStatus&);
template MapperStatus decode(ByteView);
template Bytes encode(const SegmenterStatus&);
template SegmenterStatus decode(ByteView);
template Bytes encode(const ViewerStatus&);
template ViewerStatus decode(ByteView);
template Bytes encode(const DetectorStatus&);
template DetectorStatus decode(ByteView);

}  // namespace kintsugi
