#pragma once
// Normally distributed random numbers from a hash.

#include <cstdint>

namespace kintsugi::synthetic {

/// A draw from the standard normal distribution, by its quantiles in the middles of 4,096 equal
/// shares: a look-up. Their variance is 0.9995; the largest is 3.7.
float standard_normal(std::uint32_t hash);

}  // namespace kintsugi::synthetic
