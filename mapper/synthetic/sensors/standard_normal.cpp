#include "mapper/synthetic/sensors/standard_normal.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace kintsugi::synthetic {

namespace {

constexpr int kSize = 4096;
constexpr int kHalf = kSize / 2;

std::array<float, kSize> make_quantiles() {
  std::array<float, kSize> quantiles{};
  double x = 0.0;
  for (int i = kHalf; i < kSize; ++i) {  // Newton's iteration, from the quantile before
    const double share = (i + 0.5) / kSize;
    for (int step = 0; step < 6; ++step) {
      const double above = 0.5 * std::erfc(x / std::numbers::sqrt2);
      const double density =
          std::exp(-0.5 * x * x) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
      x += (above - (1.0 - share)) / density;
    }
    quantiles[i] = static_cast<float>(x);
    quantiles[kSize - 1 - i] = -quantiles[i];
  }
  return quantiles;
}

}  // namespace

float standard_normal(std::uint32_t hash) {
  static const std::array<float, kSize> kQuantiles = make_quantiles();
  return kQuantiles[hash % kSize];
}

}  // namespace kintsugi::synthetic
