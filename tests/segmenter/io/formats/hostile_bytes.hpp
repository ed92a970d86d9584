#pragma once
// What every reader of files must survive.

#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace kintsugi::segmenter::testing {

/// Cuts the file at every byte and damages it at random: nothing but a std::runtime_error may come
/// of it; the sanitizers watch.
template <class Parse>
void expect_only_clean_errors(const std::string& whole, const Parse& parse) {
  ASSERT_NO_THROW(parse(whole));
  const auto try_to_parse = [&](const std::string& bytes) {
    try {
      parse(bytes);
    } catch (const std::runtime_error&) {
      // as it should be
    }
  };
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try_to_parse(whole.substr(0, length));
  }
  constexpr int kRounds = 3000;
  std::mt19937 random(20240117);
  for (int round = 0; round < kRounds; ++round) {
    std::string damaged = whole;
    for (int i = 0; i <= round % 4; ++i) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    try_to_parse(damaged);
  }
}

/// The message of the std::runtime_error that parsing throws.
template <class Parse>
std::string error_of(const Parse& parse) {
  try {
    parse();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace kintsugi::segmenter::testing
