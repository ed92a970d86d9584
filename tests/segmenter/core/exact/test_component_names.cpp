#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/component_names.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/segmenter/core/exact/names_check.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Points = std::vector<PointIndex>;

/// A forest that is changed by hand, as a run changes it.
class ComponentNamesTest : public ::testing::Test {
 protected:
  void add(const Points& points) {
    for (const PointIndex x : points) {
      if (x >= vertices_.size()) vertices_.resize(x + 1);
      vertices_.reset(x);
      touch(x);
    }
    added_.insert(added_.end(), points.begin(), points.end());
  }

  /// The component of a becomes host of that of b.
  void join(PointIndex a, PointIndex b) {
    const PointIndex host = forest_.root(a);
    const PointIndex guest = forest_.root(b);
    time_ += 1e-6F;
    forest_.absorb(host, guest, edges_.add(EdgeKey::of(time_, host, guest)));
    touch(host);
    touch(guest);
  }

  void release(PointIndex x) {
    const PointIndex host = forest_.release(x);
    touch(x);
    touch(host);
    for (PointIndex y = host; !vertices_.is_root(y); y = vertices_.host(y)) forest_.recount(y);
  }

  void remove(const Points& points) {
    for (const PointIndex x : points) vertices_[x].is_gone = 1;
    for (const PointIndex x : points) {
      const PointIndex heir = forest_.step_down(x);
      touch(x);
      if (heir != kNone) touch(heir);
    }
    for (const PointIndex x : points) {
      Points guests;
      forest_.history().for_each_guest(x, [&](PointIndex guest) { guests.push_back(guest); });
      for (const PointIndex guest : guests) release(guest);
      if (!vertices_.is_root(x)) release(x);
    }
    removed_.insert(removed_.end(), points.begin(), points.end());
  }

  /// Returns the points that are called another name now.
  Points update() {
    names_.update(touched_, removed_);
    return expect_named();
  }
  Points update_all() {
    for (PointIndex x = 0; x < vertices_.size(); ++x) vertices_[x].is_touched = 0;
    names_.update_all(removed_);
    return expect_named();
  }

  ComponentId name(PointIndex x) const { return names_.of_points()[x]; }

  fuzz::Random random_{1};
  Vertices vertices_;
  TreeEdges edges_{vertices_};
  JoinForest forest_{vertices_, edges_, {.threshold = 1e9, .scale = 1.0}};
  ComponentNames names_{vertices_, forest_};

 private:
  void touch(PointIndex x) {
    if (!vertices_[x].is_touched) touched_.push_back(x);
    vertices_[x].is_touched = 1;
  }

  Points expect_named() {
    check_.expect(added_);
    added_.clear();
    removed_.clear();
    touched_.clear();
    for (PointIndex x = 0; x < vertices_.size(); ++x) {
      EXPECT_EQ(vertices_[x].is_touched, 0U) << "of " << x;
      EXPECT_EQ(vertices_[x].visit, 0U) << "of " << x;
    }
    return {names_.changed().begin(), names_.changed().end()};
  }

  float time_ = 0.0F;
  Points added_;
  Points removed_;
  Points touched_;
  testing::NamesCheck check_{vertices_, forest_, names_};
};

Points range(PointIndex first, PointIndex last) {
  Points points(last - first);
  std::iota(points.begin(), points.end(), first);
  return points;
}

TEST_F(ComponentNamesTest, NewPointsAreNamed) {
  add({0, 1, 2});
  join(0, 2);
  EXPECT_THAT(update(), ElementsAre(0, 1, 2));
  EXPECT_EQ(name(0), name(2));
  EXPECT_NE(name(0), name(1));
}

TEST_F(ComponentNamesTest, NothingHappens) {
  EXPECT_THAT(update(), IsEmpty());
  add({0, 1});
  update();
  EXPECT_THAT(update(), IsEmpty());
  EXPECT_THAT(update_all(), IsEmpty());
}

TEST_F(ComponentNamesTest, TheLargerPartKeepsTheName) {
  add(range(0, 10));
  for (PointIndex x = 1; x < 6; ++x) join(0, x);
  for (PointIndex x = 7; x < 10; ++x) join(6, x);
  update();
  const ComponentId larger = name(0);
  const ComponentId smaller = name(6);
  join(6, 0);  // the smaller is the host
  EXPECT_EQ(update(), range(6, 10));
  EXPECT_EQ(name(6), larger);
  release(0);
  EXPECT_EQ(update(), range(6, 10));
  EXPECT_EQ(name(0), larger);
  EXPECT_EQ(name(6), smaller);  // free, and used again
}

TEST_F(ComponentNamesTest, AFewPointsThatLeaveGetANewName) {
  add(range(0, 100));
  for (PointIndex x = 1; x < 90; ++x) join(0, x);
  for (PointIndex x = 91; x < 100; ++x) join(90, x);
  join(0, 90);
  update();
  release(90);
  EXPECT_EQ(update(), range(90, 100));
}

TEST_F(ComponentNamesTest, AnotherRootIsNoReasonToRename) {
  constexpr PointIndex kMany = 5000;
  add(range(0, kMany));
  for (PointIndex x = 1; x < kMany; ++x) join(0, x);
  update();
  remove({0});
  EXPECT_THAT(update(), IsEmpty());
  add({0});
  join(0, 1);  // a single point absorbs all others
  EXPECT_THAT(update(), ElementsAre(0));
}

TEST_F(ComponentNamesTest, AComponentKeepsItsNameIfOnlyItsPartsWereTouched) {
  // Below the root, which is not touched itself, a piece gives place to a larger newcomer.
  add(range(0, 6));
  join(1, 2);
  join(0, 1);
  join(0, 3);
  update();
  const ComponentId before = name(0);
  release(2);
  join(4, 5);
  EXPECT_THAT(update(), ElementsAre(2, 5));
  EXPECT_EQ(name(0), before);
  EXPECT_EQ(name(1), before);
}

TEST_F(ComponentNamesTest, OfEqualPartsOneKeepsTheName) {
  add(range(0, 4));
  join(0, 1);
  join(2, 3);
  join(0, 2);
  update();
  release(2);
  EXPECT_EQ(update().size(), 2U);
}

TEST_F(ComponentNamesTest, APlaceThatIsUsedAgainIsNewWhateverItWasCalled) {
  add({0, 1});
  join(0, 1);
  update();
  remove({0, 1});
  EXPECT_THAT(update(), IsEmpty());
  add({0, 1});
  EXPECT_THAT(update(), ElementsAre(0, 1));
}

TEST_F(ComponentNamesTest, NamesAreUsedAgain) {
  // NamesCheck expects names below the number of places.
  add(range(0, 5));
  update();
  for (int n = 0; n < 30; ++n) {
    const auto x = static_cast<PointIndex>(n % 5);
    remove({x});
    if (n % 2 == 0) update();
    add({x});
    if (n % 2 != 0) continue;
    update();
  }
}

TEST_F(ComponentNamesTest, AForestBuiltAnewIsNamedAsBefore) {
  add(range(0, 20));
  for (PointIndex x = 1; x < 12; ++x) join(0, x);
  for (PointIndex x = 13; x < 20; ++x) join(12, x);
  update();
  const ComponentId larger = name(0);
  const ComponentId smaller = name(12);
  for (PointIndex x = 1; x < 12; ++x) release(x);
  for (PointIndex x = 13; x < 20; ++x) release(x);
  for (PointIndex x = 0; x < 11; ++x) join(11, x == 0 ? 0 : x);  // with other roots
  for (PointIndex x = 12; x < 19; ++x) join(19, x);
  EXPECT_THAT(update_all(), IsEmpty());
  EXPECT_EQ(name(3), larger);
  EXPECT_EQ(name(13), smaller);
  remove({0});
  EXPECT_THAT(update_all(), IsEmpty());
  EXPECT_EQ(name(0), kNoComponent);
}

TEST_F(ComponentNamesTest, AgainstRecomputationWhateverHappens) {
  constexpr PointIndex kNumPoints = 50;
  vertices_.resize(kNumPoints);
  for (int step = 0; step < 3000; ++step) {
    Points come;
    Points go;
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      const bool is_in = vertices_[x].is_gone == 0;
      if (!is_in && random_.chance(0.1)) come.push_back(x);
      if (is_in && random_.chance(0.03)) go.push_back(x);
    }
    if (step % 4 == 0) remove(go);
    if (step % 4 != 0 || go.empty()) add(come);
    for (std::size_t k = random_.below(6); k > 0; --k) {
      const auto x = static_cast<PointIndex>(random_.below(kNumPoints));
      const auto y = static_cast<PointIndex>(random_.below(kNumPoints));
      if (vertices_[x].is_gone || vertices_[y].is_gone) continue;
      if (forest_.root(x) != forest_.root(y) && random_.chance(0.7)) {
        join(x, y);
      } else if (!vertices_.is_root(x)) {
        release(x);
      }
    }
    random_.chance(0.1) ? update_all() : update();
    ASSERT_FALSE(HasFailure()) << "step " << step;
  }
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
