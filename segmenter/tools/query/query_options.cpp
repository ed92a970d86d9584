#include "segmenter/tools/query/query_options.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include <CLI/CLI.hpp>

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
      ->expected(3);
  place
      .add_option(
          "--pixel", options.pixel,
          "U V: the segment that the camera sees at this pixel now (or from --pose); integers are "
          "pixel centres")
      ->expected(2);
  place
      .add_option("--ray", options.ray,
                  "X Y Z DX DY DZ: the segment seen from X Y Z in direction DX DY DZ, frame W")
      ->expected(6);
  place
      .add_option("--box", options.box_W,
                  "X Y Z X Y Z: segments with a point between these corners, metres, frame W")
      ->expected(6);
  place.add_option("--id", options.query.segment_ids, "ID,...: the segments with these ids")
      ->delimiter(',');
}

Intrinsics given_intrinsics(const std::vector<double>& v) {
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

/// The ray of --pixel; `client` is null where there is no bus.
void look_through_pixel(const QueryOptions& options, QueryClient* client, SegmentQuery& query) {
  Intrinsics intrinsics = kinect_intrinsics();
  Pose X_WC = Pose::Identity();
  if (!options.pose.empty()) {
    X_WC = given_pose(options.pose);
  } else if (client != nullptr) {
    const HeardCamera camera =
        client->hear_camera(query.map_session, QueryClient::Seconds(options.timeout_s));
    X_WC = camera.pose.X_WC;
    intrinsics = camera.intrinsics.value_or(intrinsics);
    query.map_session = camera.pose.session;
  } else {
    throw std::invalid_argument("--pixel of a saved map needs --pose");
  }
  if (!options.intrinsics.empty()) intrinsics = given_intrinsics(options.intrinsics);
  look_along(pixel_ray(intrinsics, X_WC, options.pixel[0], options.pixel[1]), query);
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
  app.add_option("--radius", query.radius_m,
                 "--at, --pixel, --ray: maximum distance to a map point, metres; 0: two voxels")
      ->check(CLI::Range(0.0, kMaxQueryRadius_m))
      ->capture_default_str();
  app.add_option("--pose", options.pose,
                 "TX TY TZ QX QY QZ QW: camera pose for --pixel (default: the one on the bus)")
      ->expected(7);
  app.add_option("--intrinsics", options.intrinsics,
                 "FX FY CX CY WIDTH HEIGHT: camera intrinsics for --pixel (default: those of the "
                 "raw frames on the bus if there are any, else a Kinect's, 525 525 319.5 239.5 640 "
                 "480)")
      ->expected(6);
  app.add_option("--map", options.map,
                 "query this saved map (kintsugi-segmenter --save) instead of the bus");
  app.add_option("--map-name", query.map_name, "name of the map, when there are several");
  app.add_option("--map-session", query.map_session,
                 "mapper session of the map, when there are several")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--lcm-url", options.lcm_url, "the bus (default: LCM_DEFAULT_URL)");
  app.add_option("--timeout", options.timeout_s, "seconds to wait for an answer, > 0")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print a JSON object instead of a table");
}

SegmentQuery make_query(const QueryOptions& options, QueryClient* client) {
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
  if (!options.pixel.empty()) look_through_pixel(options, client, query);
  return query;
}

}  // namespace kintsugi::segmenter
