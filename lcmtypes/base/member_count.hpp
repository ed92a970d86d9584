#pragma once
// The number of data members of a struct, at compile time. A list of the members that is written by
// hand is compared with it, so that a forgotten member does not compile.

#include <cstddef>

namespace kintsugi {

/// Converts to anything; only its type is used.
struct AnyValue {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor)
};

/// The number of data members of the aggregate T, which has no arrays: as many values as it can be
/// initialized with.
template <class T, class... Values>
consteval std::size_t num_members() {
  if constexpr (requires { T{Values{}..., AnyValue{}}; }) {
    return num_members<T, Values..., AnyValue>();
  } else {
    return sizeof...(Values);
  }
}

}  // namespace kintsugi
