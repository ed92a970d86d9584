#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <kintsugi/keyframe_t.hpp>

#include "lcmtypes/codec/bulk.hpp"
#include "lcmtypes/codec/intrinsics.hpp"

namespace kintsugi {
namespace codec {

template <>
struct Bulk<KeyframeMessage> : PlacedByByte<keyframe_t> {
  static constexpr int kNumStrings = 2;
  static constexpr std::int16_t kRecordsVersion = kCloudPointVersion;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_name = from.map_name;
    to.join = from.join;
    to.number = from.number;
    to.previous = from.previous;
    to.tracked_from = from.tracked_from;
    to.part = from.part;
    to.way_m = from.way_m;
    to.unseen_m = from.unseen_m;
    to.resolution_m = from.resolution_m;
    to.noise_base_m = from.noise_base_m;
    to.noise_share = from.noise_share;
  }
  static void header_to_wire(const KeyframeMessage& keyframe, keyframe_t& wire) {
    copy(keyframe, wire);
    wire.noise_growth = keyframe.noise_growth_per_m;
    pose_to_wire(keyframe.X_UK, wire.X_UK);
    for (int i = 0; i < 36; ++i) wire.information[i] = keyframe.information_K(i / 6, i % 6);
    copy_intrinsics(keyframe.intrinsics, wire);
  }
  static void header_from_wire(const keyframe_t& wire, KeyframeMessage& keyframe) {
    copy(wire, keyframe);
    keyframe.noise_growth_per_m = wire.noise_growth;
    keyframe.X_UK = pose_from_wire(wire.X_UK);
    for (int i = 0; i < 36; ++i) keyframe.information_K(i / 6, i % 6) = wire.information[i];
    copy_intrinsics(wire, keyframe.intrinsics);
  }
  static void set_counts(keyframe_t& wire, const Counts& counts) {
    wire.num_in_volume = counts[0];
    wire.num_features = counts[1];
    wire.num_depths = counts[2];
    wire.num_intensities = counts[3];
  }
  static Counts counts(const keyframe_t& wire) {
    return {wire.num_in_volume, wire.num_features, wire.num_depths, wire.num_intensities};
  }

  static void check_header(const Check& check, const KeyframeMessage& keyframe,
                           const Counts& counts) {
    check.not_negative("utime", keyframe.utime);
    check.positive("session", keyframe.session);
    check_name(check, "map_name", keyframe.map_name);
    check_name(check, "join", keyframe.join);
    check.not_negative("number", keyframe.number);
    check.range("previous", keyframe.previous, -1, keyframe.number - 1);
    check.range("tracked_from", keyframe.tracked_from, -1, keyframe.previous);
    check.range("part", keyframe.part, 0, kMaxPart);
    check.range("way_m", keyframe.way_m, 0.0, kMaxPath_m);
    check.range("unseen_m", keyframe.unseen_m, 0.0, kMaxPath_m);
    check.range("resolution_m", keyframe.resolution_m, kMinResolution_m, kMaxResolution_m);
    check.pose("X_UK", keyframe.X_UK);
    check_information(check, keyframe.information_K);
    check.range("noise_base_m", keyframe.noise_base_m, 0.0, kMaxNoise);
    check.range("noise_share", keyframe.noise_share, 0.0, kMaxNoise);
    check.range("noise_growth", keyframe.noise_growth_per_m, 0.0, kMaxNoise);
    check_intrinsics(check, keyframe.intrinsics);
    check.range("num_in_volume", counts[0], 0, keyframe.number);
    const std::int64_t num_pixels =
        std::int64_t{keyframe.intrinsics.width} * keyframe.intrinsics.height;
    check.range<std::int64_t>("num_depths", counts[2], num_pixels, num_pixels);
    if (counts[3] != 0) {
      check.range<std::int64_t>("num_intensities", counts[3], num_pixels, num_pixels);
    }
  }
  static void check_records(const Check& check, const KeyframeMessage& keyframe) {
    for (const double coefficient : keyframe.intrinsics.distortion) {
      check.range("distortion", coefficient, 0.0, 0.0);
    }
    std::int64_t lowest = 0;
    for (const std::int32_t number : keyframe.in_volume) {
      check.range<std::int64_t>("in_volume", number, lowest, std::int64_t{keyframe.number} - 1);
      lowest = std::int64_t{number} + 1;
    }
    for (const KeyframeFeature& feature : keyframe.features) {
      check.finite("feature ray_x", feature.ray_x);
      check.finite("feature ray_y", feature.ray_y);
      check.range("feature depth_m", feature.depth_m, 0.0F, static_cast<float>(kMaxPath_m));
    }
  }

  template <class Keyframe, class Function>
  static void for_each_vector(Keyframe& keyframe, const Function& function) {
    function(keyframe.in_volume);
    function(keyframe.features);
    function(keyframe.depth);
    function(keyframe.intensity);
  }

 private:
  static constexpr std::int32_t kMaxPart = 1'000'000;  ///< one each second for 11 days
  static constexpr double kMaxPath_m = 1e9;
  static constexpr double kMaxNoise = 1e3;
  static constexpr double kMaxInformation = 1e18;  ///< of a motion of a nanometre
  static constexpr double kTolerance = 1e-9;       ///< of rounding

  static void check_name(const Check& check, const char* field, const std::string& name) {
    check.text(field, name);
    check.range<std::size_t>(field, name.size(), 0, kMaxJoinNameBytes);
  }

  /// A sum of squares: no entry is larger than those on the diagonal in its row and column, and no
  /// eigenvalue is below 0.
  static void check_information(const Check& check, const Eigen::Matrix<double, 6, 6>& A) {
    for (int i = 0; i < 6; ++i) check.range("information", A(i, i), 0.0, kMaxInformation);
    for (int i = 0; i < 36; ++i) {
      const double largest = std::sqrt(A(i / 6, i / 6) * A(i % 6, i % 6)) * (1.0 + kTolerance);
      check.range("information", A(i / 6, i % 6), -largest, largest);
      if (A(i / 6, i % 6) != A(i % 6, i / 6)) {
        check.fail("information", A(i / 6, i % 6), "a symmetric matrix");
      }
    }
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(A, Eigen::EigenvaluesOnly)
            .eigenvalues()
            .minCoeff();
    if (least < -kTolerance * A.cwiseAbs().maxCoeff()) {
      check.fail("information", least, "no eigenvalue below 0");
    }
  }
};

}  // namespace codec

template std::int64_t payload_bytes(const KeyframeMessage&);
template std::int32_t num_chunks(const KeyframeMessage&, std::size_t);
template Bytes encode_chunk(const KeyframeMessage&, std::int64_t, std::int32_t, std::size_t);
template Chunk<KeyframeMessage> decode_chunk(ByteView);
template KeyframeMessage join(const std::vector<Chunk<KeyframeMessage>>&);

}  // namespace kintsugi
