#include "lcmtypes/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace kintsugi {
namespace {

constexpr std::int64_t kMicroseconds = 1'000'000;
// The difference of two times in microseconds must fit 64 bits.
constexpr std::int64_t kMaxSeconds = 4'000'000'000'000;
constexpr double kMaxPosition_m = 1e9;
constexpr double kUnitLengthTolerance = 0.01;

std::vector<std::string> fields_of(const std::string& line) {
  std::istringstream in(line.substr(0, line.find('#')));
  std::vector<std::string> fields;
  for (std::string field; in >> field;) fields.push_back(field);
  return fields;
}

std::optional<double> parse_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

StampedPose parse_pose(const std::vector<std::string>& fields, const std::string& place) {
  if (fields.size() != 8) {
    throw std::runtime_error(place + ": " + std::to_string(fields.size()) +
                             " fields, expected 8: timestamp tx ty tz qx qy qz qw");
  }
  const auto utime = parse_seconds_us(fields[0]);
  if (!utime) throw std::runtime_error(place + ": timestamp '" + fields[0] + "' is no time in s");
  std::array<double, 7> values{};
  for (int i = 0; i < 7; ++i) {
    const auto value = parse_number(fields[i + 1]);
    if (!value) {
      throw std::runtime_error(place + ": field " + std::to_string(i + 2) + " '" + fields[i + 1] +
                               "' is no finite number");
    }
    if (i < 3 && std::abs(*value) > kMaxPosition_m) {
      throw std::runtime_error(place + ": field " + std::to_string(i + 2) + " '" + fields[i + 1] +
                               "' is farther than 1e9 m");
    }
    values[i] = *value;
  }
  const Eigen::Quaterniond q(values[6], values[3], values[4], values[5]);
  if (std::abs(q.norm() - 1.0) > kUnitLengthTolerance) {
    throw std::runtime_error(place + ": quaternion has length " + std::to_string(q.norm()) +
                             ", expected 1");
  }
  StampedPose pose;
  pose.utime = *utime;
  pose.X_WC.linear() = q.normalized().toRotationMatrix();
  pose.X_WC.translation() << values[0], values[1], values[2];
  return pose;
}

Pose interpolate(const Pose& X_WA, const Pose& X_WB, double fraction) {
  const Eigen::Quaterniond q_A(X_WA.linear());
  const Eigen::Quaterniond q_B(X_WB.linear());
  Pose X = Pose::Identity();
  X.linear() = q_A.slerp(fraction, q_B).toRotationMatrix();
  X.translation() = (1.0 - fraction) * X_WA.translation() + fraction * X_WB.translation();
  return X;
}

}  // namespace

std::optional<Pose> pose_at(const Trajectory& trajectory, std::int64_t utime) {
  const auto after = std::lower_bound(
      trajectory.begin(), trajectory.end(), utime,
      [](const StampedPose& pose, std::int64_t time) { return pose.utime < time; });
  const bool near_after = after != trajectory.end() && after->utime - utime <= kMaxPoseDistance_us;
  const bool near_before =
      after != trajectory.begin() && utime - std::prev(after)->utime <= kMaxPoseDistance_us;
  if (near_after && near_before) {
    const StampedPose& before = *std::prev(after);
    const double fraction = static_cast<double>(utime - before.utime) /
                            static_cast<double>(after->utime - before.utime);
    return interpolate(before.X_WC, after->X_WC, fraction);
  }
  if (near_after) return after->X_WC;
  if (near_before) return std::prev(after)->X_WC;
  return std::nullopt;
}

Trajectory read_tum(std::istream& in, const std::string& name) {
  Trajectory trajectory;
  int line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    const auto fields = fields_of(line);
    if (fields.empty()) continue;
    const std::string place = name + ":" + std::to_string(line_number);
    const StampedPose pose = parse_pose(fields, place);
    if (!trajectory.empty() && pose.utime <= trajectory.back().utime) {
      throw std::runtime_error(place + ": timestamp " + fields[0] +
                               " is not after that of the pose before it");
    }
    trajectory.push_back(pose);
  }
  if (in.bad()) throw std::runtime_error(name + ": cannot be read");
  if (trajectory.empty()) throw std::runtime_error(name + ": holds no pose");
  return trajectory;
}

void write_tum(std::ostream& out, const Trajectory& trajectory) {
  out << "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d& p = pose.X_WC.translation();
    const Eigen::Quaterniond q(pose.X_WC.linear());
    const char* sign = pose.utime < 0 ? "-" : "";
    const auto magnitude = pose.utime < 0 ? -pose.utime : pose.utime;
    std::array<char, 256> line{};
    std::snprintf(line.data(), line.size(), "%s%lld.%06lld %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n",
                  sign, static_cast<long long>(magnitude / kMicroseconds),
                  static_cast<long long>(magnitude % kMicroseconds), p.x(), p.y(), p.z(), q.x(),
                  q.y(), q.z(), q.w());
    out << line.data();
  }
}

std::optional<std::int64_t> parse_seconds_us(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  const std::size_t dot = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, dot);
  const std::string_view decimals = text.substr(std::min(dot + 1, text.size()));
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (whole.empty() || !std::all_of(whole.begin(), whole.end(), is_digit)) return std::nullopt;
  if (!std::all_of(decimals.begin(), decimals.end(), is_digit)) return std::nullopt;

  std::int64_t seconds = 0;
  const auto [end, error] = std::from_chars(whole.data(), whole.data() + whole.size(), seconds);
  if (error != std::errc() || seconds > kMaxSeconds) return std::nullopt;
  std::int64_t microseconds = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    microseconds = 10 * microseconds + (i < decimals.size() ? decimals[i] - '0' : 0);
  }
  if (decimals.size() > 6 && decimals[6] >= '5') ++microseconds;
  const std::int64_t total = seconds * kMicroseconds + microseconds;
  return negative ? -total : total;
}

Trajectory read_tum_file(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": " + std::strerror(errno));
  return read_tum(in, file);
}

double rotation_angle_rad(const Pose& X_AB) { return Eigen::AngleAxisd(X_AB.linear()).angle(); }

}  // namespace kintsugi
