#include "segmenter/evaluation/objects/detection_pictures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <spdlog/fmt/fmt.h>

#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/evaluation/objects/taught_model.hpp"
#include "segmenter/evaluation/report/label_color.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"
#include "segmenter/evaluation/report/splats.hpp"
#include "segmenter/evaluation/report/text_file.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kPanel_px = 480;
constexpr int kTitle_px = 24;
constexpr double kPitch_rad = 35.0 * std::numbers::pi / 180.0;  // down from the horizon
constexpr float kDarkest = 0.5F;       // of surfaces seen at a grazing angle
constexpr float kSurroundings = 0.8F;  // around the object, times its largest extent

/// What a picture is of.
struct Subject {
  std::string file;
  std::string caption;
  std::vector<CloudPoint> points_W;  ///< the object's model, or else its points in the map
};

Eigen::Vector3f position_of(const CloudPoint& p) { return {p.x, p.y, p.z}; }
Eigen::Vector3f normal_of(const CloudPoint& p) { return {p.nx, p.ny, p.nz}; }

/// Looks at the side to which most of the object's surface faces, from obliquely above.
Eigen::Matrix3f rotation_to_picture(const std::vector<CloudPoint>& points_W,
                                    const Eigen::Vector3d& up_W) {
  Eigen::Vector3d facing_W = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : points_W) facing_W += normal_of(p).cast<double>();
  facing_W -= facing_W.dot(up_W) * up_W;
  if (!(facing_W.norm() > 1e-6)) facing_W = up_W.unitOrthogonal();
  Eigen::Matrix3d R;  // level: x right, y down, z away from the viewer
  R.row(2) = -facing_W.normalized();
  R.row(1) = -up_W.normalized();
  R.row(0) = Eigen::Vector3d(R.row(1)).cross(Eigen::Vector3d(R.row(2)));
  const Eigen::AngleAxisd pitch(kPitch_rad, Eigen::Vector3d::UnitX());
  return (pitch.toRotationMatrix() * R).cast<float>();
}

class Scene {
 public:
  Scene(const Subject& subject, const LabelledPoints& map, const Eigen::Vector3d& up_W)
      : R_(rotation_to_picture(subject.points_W, up_W)) {
    Eigen::AlignedBox3f box_W;
    for (const CloudPoint& p : subject.points_W) box_W.extend(position_of(p));
    center_W_ = box_W.center();
    radius_m_ = std::max((0.5F + kSurroundings) * box_W.sizes().maxCoeff(), 10 * map.resolution_m);
    const float px_per_m = static_cast<float>(kPanel_px) / (2.0F * radius_m_);
    view_ = {.corner = (R_ * center_W_).head<2>().array() - radius_m_,
             .px_per_m = px_per_m,
             .size = {kPanel_px, kPanel_px},
             .radius_px = std::clamp(
                 static_cast<int>(std::ceil(0.6F * map.resolution_m * px_per_m)), 0, kPanel_px)};
  }

  /// @param color of the point with this index: blue, green, red
  template <typename Color>
  cv::Mat3b draw(std::span<const CloudPoint> points_W, const Color& color) const {
    std::vector<Splat> splats;
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      const CloudPoint& p = points_W[i];
      // A ball, so that what stands between object and viewer is left out.
      if ((position_of(p) - center_W_).norm() > radius_m_) continue;
      const float towards_viewer = -(R_ * normal_of(p)).z();
      if (towards_viewer < 0.0F) continue;
      const float shade = kDarkest + (1.0F - kDarkest) * towards_viewer;
      splats.push_back({R_ * position_of(p), shade * color(i)});
    }
    return draw_splats(splats, view_);
  }

 private:
  Eigen::Matrix3f R_;
  Eigen::Vector3f center_W_;
  float radius_m_ = 0.0F;
  SplatView view_;
};

cv::Vec3f own_color(const CloudPoint& p) {
  return {static_cast<float>(p.blue), static_cast<float>(p.green), static_cast<float>(p.red)};
}

cv::Mat3b titled(const cv::Mat3b& panel, const std::string& title) {
  cv::Mat3b picture(panel.rows + kTitle_px, panel.cols, cv::Vec3b(255, 255, 255));
  panel.copyTo(picture(cv::Rect(0, kTitle_px, panel.cols, panel.rows)));
  cv::putText(picture, title, {6, 17}, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar::all(30), 1,
              cv::LINE_AA);
  return picture;
}

std::string png_of(const Subject& subject, const LabelledPoints& map, const Eigen::Vector3d& up_W) {
  const Scene scene(subject, map, up_W);
  const auto map_color = [&](std::size_t i) { return own_color(map.points_W[i]); };
  const auto model_color = [&](std::size_t i) { return own_color(subject.points_W[i]); };
  const auto segment_color = [&](std::size_t i) {
    const std::uint32_t id = map.segment_ids[i];
    return id == 0 ? cv::Vec3f::all(200.0F) : cv::Vec3f(color_of_label(id));
  };
  cv::Mat3b picture;
  cv::hconcat(std::vector<cv::Mat3b>{titled(scene.draw(map.points_W, map_color), "map"),
                                     titled(scene.draw(subject.points_W, model_color), "object"),
                                     titled(scene.draw(map.points_W, segment_color), "segments")},
              picture);
  std::vector<unsigned char> png;
  cv::imencode(".png", picture, png);
  return {png.begin(), png.end()};
}

std::vector<CloudPoint> points_of_instance(std::uint32_t instance, const LabelledPoints& map,
                                           const Truth& truth) {
  const std::vector<std::uint32_t> instances =
      instances_at(map.points_W, truth, static_cast<double>(map.resolution_m));
  std::vector<CloudPoint> points;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i] == instance) points.push_back(map.points_W[i]);
  }
  return points;
}

std::vector<Subject> subjects_of(const std::vector<ToldDetection>& told, const ObjectScores& scores,
                                 const LabelledPoints& map, const Truth& truth,
                                 const std::filesystem::path& library) {
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < told.size(); ++i) {
    const ClaimOutcome& claim = scores.claims[i];
    if (claim.is_right) continue;
    subjects.push_back(
        {.file = fmt::format("false_{}.png", claim.id),
         .caption = fmt::format("false: {} ({}), score {:.2f}, {} points: {}", claim.kind, claim.id,
                                claim.score.value_or(0.0), claim.points, claim.reason),
         .points_W = transformed(told[i].X_WO, read_taught_model(library, claim.kind).points_O)});
  }
  for (const TrueOutcome& object : scores.truth) {
    if (object.is_found) continue;
    subjects.push_back(
        {.file = fmt::format("missed_{}.png", object.instance),
         .caption =
             fmt::format("missed: {}, {} points: {}", object.key, object.points, object.reason),
         .points_W = object.X_WO ? transformed(*object.X_WO,
                                               read_taught_model(library, object.name).points_O)
                                 : points_of_instance(object.instance, map, truth)});
  }
  return subjects;
}

void remove_earlier(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = name.starts_with("false_") || name.starts_with("missed_");
    if (is_ours && name.ends_with(".png")) std::filesystem::remove(entry.path());
  }
}

}  // namespace

std::vector<DetectionPicture> write_detection_pictures(
    const std::vector<ToldDetection>& told, const ObjectScores& scores, const LabelledPoints& map,
    const Truth& truth, const std::filesystem::path& library, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  remove_earlier(folder);
  UpDirection up;
  up.add(map.points_W);
  std::vector<DetectionPicture> pictures;
  std::string page;
  for (const Subject& subject : subjects_of(told, scores, map, truth, library)) {
    if (subject.points_W.empty()) continue;
    const std::string png = png_of(subject, map, up.up_W());
    write_text_file(folder / subject.file, png);
    page += html_picture(subject.file, png, subject.caption);
    pictures.push_back({subject.file, subject.caption});
  }
  write_text_file(folder / "pictures.html", html_page("Detections, false and missed", page));
  return pictures;
}

}  // namespace kintsugi::segmenter
