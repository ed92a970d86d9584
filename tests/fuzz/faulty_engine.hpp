#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tests/fuzz/run_scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// An error that happens once in an engine that is correct otherwise.
enum class Fault : std::uint8_t {
  kNone,
  kWrongLabel,      ///< a point is in the component of another
  kWrongTheta,      ///< theta of one component is off by one bit
  kGoneStays,       ///< a removed point keeps its component
  kChangeLeftOut,   ///< changed() leaves a point out
  kChangeMadeUp,    ///< changed() has a point whose component kept its name
  kNameOutOfRange,  ///< a component has the name size()
  kThrows,
};

/// An engine of the given kind with `fault` in the first update from `step` (counted from 0) on
/// that leaves room for it.
EngineFactory faulty(const EngineFactory& make_engine, Fault fault, std::size_t step);

}  // namespace kintsugi::segmenter::fuzz
