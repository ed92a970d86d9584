#pragma once
// The key of the fuzzer of signed messages, which its seeds and its mutator have, too.

#include "lcmtypes/signing/signed_message.hpp"

namespace kintsugi::fuzzing {

inline constexpr char kSignedChannel[] = "X";

inline const BusKey& signed_key() {
  static const BusKey key(BusKey::Secret{1, 2, 3});
  return key;
}

}  // namespace kintsugi::fuzzing
