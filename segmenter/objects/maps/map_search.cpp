#include "segmenter/objects/maps/map_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>

#include <opencv2/core.hpp>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/objects/model/shortest_rotation.hpp"

namespace kintsugi::segmenter {
namespace {

// Frame L of a map: z up, the origin that of W.

constexpr double kLeastCell_m = 0.1;  // finer than furniture, coarser than the tilt's error
constexpr int kMostCells = 512;       // along a side of the plane; a larger map has larger cells
constexpr double kBand_m = 0.4;       // of height; a table is in another one than the floor
constexpr int kNumBands = 8;          // the room above is in the last one
constexpr int kNumDirections = 6;     // of normals: up, down and four horizontal ones
constexpr double kHeightBin_m = 0.05;
constexpr int kNumTurns = 8;
constexpr int kNumHeights = 2;
constexpr int kNumPlaces = 3;  // of a turn and a height
constexpr double kApart_m = 0.5;
constexpr int kApart_deg = 10;

struct Peak {
  double value = 0.0;
  int place = 0;
};

/// The local maxima of a row, largest first, each at least `apart` from a larger one.
std::vector<Peak> peaks_of(const std::vector<double>& row, int apart, int most, bool is_circular) {
  const int size = static_cast<int>(row.size());
  std::vector<Peak> all;
  all.reserve(row.size());
  for (int i = 0; i < size; ++i) all.push_back({row[static_cast<std::size_t>(i)], i});
  std::ranges::stable_sort(all, std::ranges::greater{}, &Peak::value);
  std::vector<Peak> peaks;
  for (const Peak& peak : all) {
    if (static_cast<int>(peaks.size()) >= most) break;
    const bool is_near = std::ranges::any_of(peaks, [&](const Peak& larger) {
      const int distance = std::abs(larger.place - peak.place);
      return (is_circular ? std::min(distance, size - distance) : distance) < apart;
    });
    if (!is_near) peaks.push_back(peak);
  }
  return peaks;
}

Pose level_pose(const Eigen::Vector3d& up) {
  Pose X_LW = Pose::Identity();
  X_LW.linear() = shortest_rotation(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return X_LW;
}

/// How much surface faces each degree of azimuth, smoothed.
std::vector<double> directions_of(const std::vector<CloudPoint>& samples_L) {
  std::vector<double> counts(360, 0.0);
  for (const CloudPoint& sample : samples_L) {
    if (std::abs(sample.nz) > 0.3F) continue;
    const double degrees = std::atan2(sample.ny, sample.nx) * 180.0 / std::numbers::pi;
    counts[static_cast<std::size_t>(std::lround(degrees + 360.0)) % 360] += 1.0;
  }
  std::vector<double> smooth(360, 0.0);
  for (int i = 0; i < 360; ++i) {
    for (int d = -4; d <= 4; ++d) {
      smooth[static_cast<std::size_t>(i)] +=
          counts[static_cast<std::size_t>((i + d + 360) % 360)] * std::exp(-0.125 * d * d);
    }
  }
  return smooth;
}

/// Turns of B about the vertical, degrees.
std::vector<Peak> turns_of(const std::vector<CloudPoint>& A_L, const std::vector<CloudPoint>& B_L) {
  const std::vector<double> a = directions_of(A_L);
  const std::vector<double> b = directions_of(B_L);
  std::vector<double> agreement(360, 0.0);
  for (std::size_t turn = 0; turn < 360; ++turn) {
    for (std::size_t i = 0; i < 360; ++i) agreement[turn] += b[i] * a[(i + turn) % 360];
  }
  return peaks_of(agreement, kApart_deg, kNumTurns, true);
}

struct Heights {
  double low_m = 0.0;
  std::vector<double> up;  // number of samples in each bin
  std::vector<double> down;
};

Heights heights_of(const std::vector<CloudPoint>& samples_L) {
  Heights heights;
  if (samples_L.empty()) return heights;
  const auto [low, high] = std::ranges::minmax_element(samples_L, {}, &CloudPoint::z);
  heights.low_m = low->z;
  const auto size = static_cast<std::size_t>((high->z - low->z) / kHeightBin_m) + 2;
  heights.up.resize(size);
  heights.down.resize(size);
  for (const CloudPoint& sample : samples_L) {
    if (std::abs(sample.nz) < 0.8F) continue;
    const double place = (sample.z - heights.low_m) / kHeightBin_m;
    const auto bin = static_cast<std::size_t>(place);
    const double upper = place - std::floor(place);
    std::vector<double>& counts = sample.nz > 0.0F ? heights.up : heights.down;
    counts[bin] += 1.0 - upper;
    counts[bin + 1] += upper;
  }
  return heights;
}

/// How far B is to be lifted, metres.
std::vector<double> lifts_of(const std::vector<CloudPoint>& A_L,
                             const std::vector<CloudPoint>& B_L) {
  const Heights a = heights_of(A_L);
  const Heights b = heights_of(B_L);
  const std::ptrdiff_t size_a = std::ssize(a.up);
  const std::ptrdiff_t size_b = std::ssize(b.up);
  std::vector<double> agreement(a.up.size() + b.up.size(), 0.0);
  for (std::ptrdiff_t shift = -size_b; shift < size_a; ++shift) {
    double& sum = agreement[static_cast<std::size_t>(shift + size_b)];
    const std::ptrdiff_t end = std::min(size_b, size_a - shift);
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -shift); i < end; ++i) {
      const auto in_b = static_cast<std::size_t>(i);
      const auto in_a = static_cast<std::size_t>(i + shift);
      // The root: a floor seen in full must not outweigh table tops.
      sum += std::sqrt(b.up[in_b] * a.up[in_a]) + std::sqrt(b.down[in_b] * a.down[in_a]);
    }
  }
  std::vector<double> lifts;
  for (const Peak& peak : peaks_of(agreement, 4, kNumHeights, false)) {
    lifts.push_back(static_cast<double>(peak.place - size_b) * kHeightBin_m + a.low_m - b.low_m);
  }
  return lifts;
}

/// The plane, cut into cells, of both maps: large enough that nothing wraps around.
struct Plane {
  double cell_m = kLeastCell_m;
  int side = 0;  ///< cells
  double lowest_m = 0.0;
};

double radius_of(const std::vector<CloudPoint>& samples_L, const Eigen::Vector2d& center) {
  double radius_m = 0.0;
  for (const CloudPoint& sample : samples_L) {
    radius_m = std::max(radius_m, (Eigen::Vector2d(sample.x, sample.y) - center).norm());
  }
  return radius_m;
}

Eigen::Vector2d center_of(const std::vector<CloudPoint>& samples_L) {
  Eigen::AlignedBox2d box;
  for (const CloudPoint& sample : samples_L) box.extend(Eigen::Vector2d(sample.x, sample.y));
  return box.isEmpty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(box.center());
}

constexpr std::size_t kNumImages = std::size_t{kNumBands} * kNumDirections;
using Images = std::array<cv::Mat1f, kNumImages>;

/// The surface in each band of height and direction, spread over the neighbouring cells. The centre
/// of the image is at `center`.
Images draw(const std::vector<CloudPoint>& samples_L, const Eigen::Vector2d& center,
            const Plane& plane) {
  Images images;
  for (cv::Mat1f& image : images) image = cv::Mat1f::zeros(plane.side, plane.side);
  for (const CloudPoint& sample : samples_L) {
    const double band = std::clamp((sample.z - plane.lowest_m) / kBand_m, 0.0, kNumBands - 1.001);
    const double upper = band - std::floor(band);
    const double u = (sample.x - center.x()) / plane.cell_m + 0.5 * plane.side;
    const double v = (sample.y - center.y()) / plane.cell_m + 0.5 * plane.side;
    const auto i = static_cast<int>(std::floor(u));
    const auto j = static_cast<int>(std::floor(v));
    if (i < 0 || j < 0 || i + 1 >= plane.side || j + 1 >= plane.side) continue;
    const std::array<float, kNumDirections> along = {sample.nz,  -sample.nz, sample.nx,
                                                     -sample.nx, sample.ny,  -sample.ny};
    for (std::size_t direction = 0; direction < kNumDirections; ++direction) {
      const double share = along[direction] > 0.0F ? along[direction] * along[direction] : 0.0;
      if (share < 0.01) continue;
      for (int above = 0; above < 2; ++above) {
        const double weight = share * (above == 1 ? upper : 1.0 - upper);
        const auto image =
            (static_cast<std::size_t>(band) + static_cast<std::size_t>(above)) * kNumDirections +
            direction;
        if (image >= kNumImages) continue;
        for (int dj = 0; dj < 2; ++dj) {
          for (int di = 0; di < 2; ++di) {
            const double part = std::abs(1.0 - di - (u - i)) * std::abs(1.0 - dj - (v - j));
            images[image](j + dj, i + di) += static_cast<float>(weight * part);
          }
        }
      }
    }
  }
  return images;
}

double energy_of(const Images& images) {
  double energy = 0.0;
  for (const cv::Mat1f& image : images) energy += image.dot(image);
  return energy;
}

Images spectra_of(Images images) {
  for (cv::Mat1f& image : images) {
    if (cv::countNonZero(image) == 0) {
      image.release();
    } else {
      cv::dft(image, image);
    }
  }
  return images;
}

/// The places in the plane with the largest correlation of A and B: shifts in cells, best first.
std::vector<std::pair<double, cv::Point>> best_shifts(const Images& A, const Images& B,
                                                      const Plane& plane) {
  cv::Mat1f sum = cv::Mat1f::zeros(plane.side, plane.side);
  cv::Mat1f product;
  for (std::size_t i = 0; i < kNumImages; ++i) {
    if (A[i].empty() || B[i].empty()) continue;
    cv::mulSpectrums(A[i], B[i], product, 0, true);
    sum += product;
  }
  cv::Mat1f correlation;
  cv::dft(sum, correlation, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  std::vector<std::pair<double, cv::Point>> best;
  const int apart = std::max(1, static_cast<int>(kApart_m / plane.cell_m));
  for (int k = 0; k < kNumPlaces; ++k) {
    double value = 0.0;
    cv::Point place;
    cv::minMaxLoc(correlation, nullptr, &value, nullptr, &place);
    const auto signed_shift = [&](int at) { return at < plane.side / 2 ? at : at - plane.side; };
    best.emplace_back(value, cv::Point(signed_shift(place.x), signed_shift(place.y)));
    for (int dj = -apart; dj <= apart; ++dj) {
      for (int di = -apart; di <= apart; ++di) {
        correlation((place.y + dj + plane.side) % plane.side,
                    (place.x + di + plane.side) % plane.side) = 0.0F;
      }
    }
  }
  return best;
}

}  // namespace

std::vector<MapHypothesis> search_map(std::span<const CloudPoint> samples_A,
                                      const Eigen::Vector3d& up_A,
                                      std::span<const CloudPoint> samples_B,
                                      const Eigen::Vector3d& up_B, std::size_t most) {
  const std::vector<CloudPoint> A_L = transformed(level_pose(up_A), samples_A);
  const std::vector<CloudPoint> B_L = transformed(level_pose(up_B), samples_B);
  if (A_L.empty() || B_L.empty()) return {};
  const Eigen::Vector2d center_A = center_of(A_L);
  const Eigen::Vector2d center_B = center_of(B_L);
  Plane plane;
  const double extent_m = 2.0 * (radius_of(A_L, center_A) + radius_of(B_L, center_B)) + 1.0;
  plane.cell_m = std::max(kLeastCell_m, extent_m / kMostCells);
  plane.side = cv::getOptimalDFTSize(static_cast<int>(std::ceil(extent_m / plane.cell_m)));
  plane.lowest_m = std::ranges::min_element(A_L, {}, &CloudPoint::z)->z;
  Images images_A = draw(A_L, center_A, plane);
  const double energy_A = energy_of(images_A);
  const Images spectra_A = spectra_of(std::move(images_A));
  const Pose X_LW_A = level_pose(up_A);
  const Pose X_LW_B = level_pose(up_B);
  std::vector<MapHypothesis> all;
  for (const Peak& turn : turns_of(A_L, B_L)) {
    for (const double lift_m : lifts_of(A_L, B_L)) {
      Pose X_TL = Pose::Identity();  // turned and lifted about the centre of B
      X_TL.linear() =
          Eigen::AngleAxisd(turn.place * std::numbers::pi / 180.0, Eigen::Vector3d::UnitZ())
              .toRotationMatrix();
      const Eigen::Vector3d center(center_B.x(), center_B.y(), 0.0);
      X_TL.translation() = center - X_TL.linear() * center + Eigen::Vector3d(0, 0, lift_m);
      Images images_B = draw(transformed(X_TL, B_L), center_B, plane);
      const double scale = 1.0 / std::sqrt(energy_A * energy_of(images_B) + 1e-12);
      for (const auto& [value, shift] :
           best_shifts(spectra_A, spectra_of(std::move(images_B)), plane)) {
        Pose X_LT = Pose::Identity();
        X_LT.translation() << center_A.x() - center_B.x() + shift.x * plane.cell_m,
            center_A.y() - center_B.y() + shift.y * plane.cell_m, 0.0;
        all.push_back({X_LW_A.inverse(Eigen::Isometry) * X_LT * X_TL * X_LW_B, value * scale});
      }
    }
  }
  std::ranges::stable_sort(all, std::ranges::greater{}, &MapHypothesis::score);
  if (all.size() > most) all.resize(most);
  return all;
}

}  // namespace kintsugi::segmenter
