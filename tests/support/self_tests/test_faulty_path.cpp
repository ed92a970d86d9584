#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>

#include "tests/support/faulty_path.hpp"

namespace kintsugi::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kDatagrams = 10'000;

Bytes datagram(int number) {
  return {static_cast<std::uint8_t>(number & 255), static_cast<std::uint8_t>(number >> 8)};
}
int number_of(const Bytes& datagram) { return datagram.at(0) + 256 * datagram.at(1); }

/// One datagram a millisecond; what comes out, in order, in the end all of it.
std::vector<int> numbers_out(FaultyPath& path) {
  std::vector<int> numbers;
  numbers.reserve(std::size_t{2} * kDatagrams);
  for (int i = 0; i < kDatagrams + 1000; ++i) {
    const double now_s = 1e-3 * i;
    if (i < kDatagrams) path.put(datagram(i), now_s);
    while (const auto next = path.take(now_s)) numbers.push_back(number_of(*next));
  }
  EXPECT_FALSE(path.next_due_s().has_value());
  return numbers;
}

/// Five standard deviations of a binomial count.
double tolerance(double share) { return 5.0 * std::sqrt(kDatagrams * share * (1.0 - share)); }

TEST(FaultyPath, PassesEverythingOnInOrderWithoutFaults) {
  FaultyPath path({});
  const std::vector<int> numbers = numbers_out(path);
  ASSERT_EQ(numbers.size(), std::size_t{kDatagrams});
  EXPECT_TRUE(std::ranges::is_sorted(numbers));
  EXPECT_EQ(path.counts().overtaken, 0);
}

TEST(FaultyPath, DropsAndDoublesTheSharesAskedFor) {
  FaultyPath path({.drop = 0.1, .duplicate = 0.05});
  const std::vector<int> numbers = numbers_out(path);
  const std::set<int> different(numbers.begin(), numbers.end());
  const FaultyPath::Counts& counts = path.counts();
  EXPECT_NEAR(static_cast<double>(counts.dropped), kDatagrams * 0.1, tolerance(0.1));
  EXPECT_NEAR(static_cast<double>(counts.duplicated), kDatagrams * 0.045, tolerance(0.045));
  EXPECT_EQ(counts.in, kDatagrams);
  EXPECT_EQ(counts.out, counts.in - counts.dropped + counts.duplicated);
  EXPECT_EQ(std::ssize(numbers), counts.out);
  EXPECT_EQ(std::ssize(different), counts.in - counts.dropped);
}

TEST(FaultyPath, HoldsSomeBackSoThatOthersOvertake) {
  FaultyPath path({.hold_back = 0.1, .held_s = 0.02});
  const std::vector<int> numbers = numbers_out(path);
  ASSERT_EQ(numbers.size(), std::size_t{kDatagrams});
  EXPECT_FALSE(std::ranges::is_sorted(numbers));
  EXPECT_GT(path.counts().overtaken, kDatagrams / 20);
  int newest = 0;
  for (const int number : numbers) {
    newest = std::max(newest, number);
    ASSERT_LE(newest - number, 21) << "later than by 20 ms, at one datagram a millisecond";
  }
}

TEST(FaultyPath, KeepsEverythingForTheDelay) {
  FaultyPath path({.delay_s = 0.5});
  path.put(datagram(1), 10.0);
  EXPECT_EQ(path.next_due_s(), 10.5);
  EXPECT_FALSE(path.take(10.4).has_value());
  EXPECT_EQ(path.take(10.5), datagram(1));
  EXPECT_FALSE(path.take(11.0).has_value());
}

TEST(FaultyPath, DoesTheSameForTheSameSeed) {
  const FaultyPath::Config config{.drop = 0.2, .duplicate = 0.2, .hold_back = 0.2};
  FaultyPath first(config);
  FaultyPath again(config);
  FaultyPath other({.drop = 0.2, .duplicate = 0.2, .hold_back = 0.2, .seed = 2});
  const std::vector<int> numbers = numbers_out(first);
  EXPECT_EQ(numbers_out(again), numbers);
  EXPECT_NE(numbers_out(other), numbers);
}

TEST(FaultyPath, DropsTheSameWhateverElseItDoes) {
  FaultyPath only_drops({.drop = 0.1});
  FaultyPath all({.drop = 0.1, .duplicate = 0.3, .hold_back = 0.3});
  const std::vector<int> some = numbers_out(only_drops);
  const std::vector<int> others = numbers_out(all);
  EXPECT_EQ(std::set<int>(some.begin(), some.end()), std::set<int>(others.begin(), others.end()));
}

TEST(FaultyPath, NamesFieldValueAndBound) {
  EXPECT_THAT([] { FaultyPath({.drop = 1.5}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("drop is 1.5")));
  EXPECT_THAT([] { FaultyPath({.held_s = -1.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("held_s is -1")));
}

}  // namespace
}  // namespace kintsugi::testing
