#pragma once
// Checks of message fields. Each error names type, field, value and what was expected.

#include <sstream>
#include <stdexcept>
#include <string>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::codec {

/// Checks the fields of one message. @throws std::invalid_argument from every function
class Check {
 public:
  /// @param type name of the LCM type, for errors
  explicit Check(const char* type) : type_(type) {}

  template <class Value>
  [[noreturn]] void fail(const char* field, const Value& value, const std::string& expected) const {
    std::ostringstream text;
    text << type_ << '.' << field << " is " << value << ", expected " << expected;
    throw std::invalid_argument(text.str());
  }

  /// `low` <= `value` <= `high`; NaN fails.
  template <class Value>
  void range(const char* field, Value value, Value low, Value high) const {
    if (value >= low && value <= high) return;
    std::ostringstream bounds;
    bounds << low << " .. " << high;
    fail(field, +value, bounds.str());
  }

  void not_negative(const char* field, std::int64_t value) const {
    if (value < 0) fail(field, value, ">= 0");
  }
  void positive(const char* field, std::int64_t value) const {
    if (value <= 0) fail(field, value, "> 0");
  }
  void finite(const char* field, double value) const;
  /// A coordinate of a pose, metres.
  void position(const char* field, double value) const;

  /// At most kMaxStringBytes long and without control characters, because texts are printed in
  /// terminals.
  void text(const char* field, const std::string& value) const;

  /// Finite, and its linear part is a rotation.
  void pose(const char* field, const Pose& value) const;

  /// The packed records of the message have the layout that this program knows.
  void records_version(std::int16_t version, std::int16_t known) const;

 private:
  const char* type_;
};

inline void check_state(const Check& check, TrackingState state) {
  check.range("state", static_cast<int>(state), 0, static_cast<int>(TrackingState::kGiven));
}

/// Converts a pose to the rows of [R | t], and back.
void pose_to_wire(const Pose& X, double (&rows)[12]);
Pose pose_from_wire(const double (&rows)[12]);

/// Returns decode(). @throws DecodeError where decode throws std::invalid_argument
template <class Decode>
auto as_decode_error(const Decode& decode) {
  try {
    return decode();
  } catch (const std::invalid_argument& error) {
    throw DecodeError(error.what());
  }
}

}  // namespace kintsugi::codec
