#include "segmenter/tools/query/query_options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/query/pixel_ray.hpp"

namespace kintsugi::segmenter {
namespace {

void add_places(CLI::App& app, QueryOptions& options) {
  CLI::Option_group& place =
      *app.add_option_group("Where", "at most one of these; default: everywhere");
  place.require_option(0, 1);
  place
      .add_option("--at", options.point_W,
                  "X Y Z: the segment of the nearest map point, metres, frame W")
      ->expected(3)
      ->check(finite_number());
  place
      .add_option(
          "--pixel", options.pixel,
          "U V: the segment of the surface that the camera measures at this pixel of its depth "
          "image "
          "now; integers are pixel centres. Exit code 3: no view of the camera, 4: it measures "
          "nothing there, 5: the surface is in no segment yet. With --pose: what a camera there "
          "would see of the map")
      ->expected(2)
      ->check(finite_number());
  place
      .add_option("--ray", options.ray,
                  "X Y Z DX DY DZ: the segment seen from X Y Z in direction DX DY DZ, frame W")
      ->expected(6)
      ->check(finite_number());
  place
      .add_option("--box", options.box_W,
                  "X Y Z X Y Z: segments with a point between these corners, metres, frame W")
      ->expected(6)
      ->check(finite_number());
  place.add_option("--id", options.query.segment_ids, "ID,...: the segments with these ids")
      ->delimiter(',');
  place
      .add_option("--object", options.object,
                  "NAME: where the known object of this name is, as kintsugi-objects detect has "
                  "found it. Exit code 6: no such object found")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return is_object_name(name) ? std::string()
                                        : "'" + name + "' is not 1 to 64 letters, digits, - and _";
          },
          "NAME"));
  place.add_flag("--objects", options.objects, "all known objects that are found");
}

/// Within the bounds of a message's.
Intrinsics given_intrinsics(const std::vector<double>& v) {
  constexpr double kMaxFocalLength_px = 10.0 * kMaxImageSide_px;
  check_range("--intrinsics: FX", v[0], 1.0, kMaxFocalLength_px);
  check_range("--intrinsics: FY", v[1], 1.0, kMaxFocalLength_px);
  for (const auto& [name, side_px] : {std::pair{"WIDTH", v[4]}, {"HEIGHT", v[5]}}) {
    const std::string field = std::string("--intrinsics: ") + name;
    check_range(field, side_px, 1.0, double{kMaxImageSide_px});
    require(side_px == std::floor(side_px), field, side_px, "a whole number");
  }
  return {.fx = v[0],
          .fy = v[1],
          .cx = v[2],
          .cy = v[3],
          .width = static_cast<int>(v[4]),
          .height = static_cast<int>(v[5])};
}

Pose given_pose(const std::vector<double>& v) {
  const Eigen::Quaterniond q_WC(v[6], v[3], v[4], v[5]);
  if (!(q_WC.norm() > 1e-9)) throw std::invalid_argument("--pose: QX QY QZ QW are all 0");
  Pose X_WC = Pose::Identity();
  X_WC.linear() = q_WC.normalized().toRotationMatrix();
  X_WC.translation() << v[0], v[1], v[2];
  return X_WC;
}

void look_along(const Ray& ray, SegmentQuery& query) {
  query.place = QueryPlace::kRay;
  for (int axis = 0; axis < 3; ++axis) {
    query.point_W[axis] = ray.origin_W[axis];
    query.direction_W[axis] = ray.direction_W[axis];
  }
}

/// What a camera at --pose would see of the map, which may be hidden behind what is not mapped yet.
void look_through_pixel(const QueryOptions& options, SegmentQuery& query) {
  const Intrinsics intrinsics =
      options.intrinsics.empty() ? kinect_intrinsics() : given_intrinsics(options.intrinsics);
  look_along(pixel_ray(intrinsics, given_pose(options.pose), options.pixel[0], options.pixel[1]),
             query);
}

void ask_for_pixel(const QueryOptions& options, SegmentQuery& query) {
  if (!options.pose.empty()) return look_through_pixel(options, query);
  if (!options.map.empty()) throw std::invalid_argument("--pixel of a saved map needs --pose");
  query.place = QueryPlace::kPixel;
  std::copy_n(options.pixel.begin(), 2, query.pixel_px);
}

}  // namespace

void add_options(CLI::App& app, QueryOptions& options) {
  SegmentQuery& query = options.query;
  query.max_segments = 10;
  add_places(app, options);
  app.add_flag("--planar", query.only_planar, "only planar segments");
  app.add_option("--changed-since", query.changed_since,
                 "only segments that changed after this device time, microseconds")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--largest", query.max_segments, "only the N largest; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option(
         "--radius", query.radius_m,
         "--at, --pixel, --ray: maximum distance to a map point, metres; 0: two voxels, for "
         "--pixel without --pose at least 0.03")
      ->check(number_range(0.0, kMaxQueryRadius_m))
      ->capture_default_str();
  auto* const pose =
      app.add_option(
             "--pose", options.pose,
             "TX TY TZ QX QY QZ QW: with --pixel, the pose of a camera, instead of what the "
             "camera on the bus measures")
          ->expected(7)
          ->check(finite_number())
          ->needs(app.get_option("--pixel"));
  app.add_option("--intrinsics", options.intrinsics,
                 "FX FY CX CY WIDTH HEIGHT: of the camera at --pose (default: a Kinect's, 525 525 "
                 "319.5 239.5 640 480)")
      ->expected(6)
      ->check(finite_number())
      ->needs(pose);
  app.add_option("--map", options.map,
                 "query this saved map (kintsugi-segmenter --save) instead of the bus")
      ->check(CLI::Validator(
          [](const std::string& file) { return file.empty() ? "is empty" : std::string(); }, ""));
  app.add_option("--map-name", query.map_name, "name of the map, when there are several");
  app.add_option("--map-session", query.map_session,
                 "mapper session of the map, when there are several")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--lcm-url", options.lcm_url, "the bus (default: LCM_DEFAULT_URL)");
  add_bus_key_flag(app);
  app.add_option("--timeout", options.timeout_s, "seconds to wait for an answer, > 0")
      ->check(number_range(0.001, 1e6))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print a JSON object instead of a table");
}

SegmentQuery make_query(const QueryOptions& options) {
  SegmentQuery query = options.query;
  if (!query.segment_ids.empty()) query.place = QueryPlace::kIds;
  if (!options.point_W.empty()) {
    query.place = QueryPlace::kPoint;
    std::copy_n(options.point_W.begin(), 3, query.point_W);
  }
  if (!options.ray.empty()) {
    const Eigen::Vector3d direction_W(options.ray[3], options.ray[4], options.ray[5]);
    if (!(direction_W.norm() > 1e-9)) throw std::invalid_argument("--ray: DX DY DZ are all 0");
    look_along(
        {Eigen::Vector3d(options.ray[0], options.ray[1], options.ray[2]), direction_W.normalized()},
        query);
  }
  if (!options.box_W.empty()) {
    query.place = QueryPlace::kBox;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::tie(query.box_min_W[axis], query.box_max_W[axis]) =
          std::minmax(options.box_W[axis], options.box_W[axis + 3]);
    }
  }
  if (!options.pixel.empty()) ask_for_pixel(options, query);
  return query;
}

}  // namespace kintsugi::segmenter
