#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mapper/evaluation/scene_pairs.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"

namespace kintsugi::mapper {
namespace {

nlohmann::json pairs(const char* before, const char* after, bool with_changes) {
  const synthetic::Scene a = synthetic::make_scene(before);
  const synthetic::Scene b = synthetic::make_scene(after);
  return nlohmann::json::parse(scene_pairs_json({before, a}, {after, b}, with_changes));
}

TEST(ScenePairs, ChangesHaveTheIdsAndPosesThatExist) {
  const auto json = pairs("office", "office-later", true);
  std::map<std::string, int> counts;
  for (const auto& change : json.at("changes")) {
    const std::string kind = change.at("kind");
    ++counts[kind];
    EXPECT_EQ(change.contains("id_before"), kind != "new");
    EXPECT_EQ(change.contains("X_SG_after"), kind != "gone");
    EXPECT_EQ(change.contains("X_after_before_S"), kind == "moved");
    EXPECT_TRUE(change.at("symmetry").contains("axes"));
  }
  EXPECT_EQ(counts, (std::map<std::string, int>{{"gone", 10}, {"moved", 10}, {"new", 10}}));
}

TEST(ScenePairs, TheUnchangedRoomHasNoChange) {
  EXPECT_TRUE(pairs("office", "office-again", true).at("changes").empty());
}

TEST(ScenePairs, ObjectsOfAnotherRoomArePairedByTheirModel) {
  const auto json = pairs("office", "kitchen", false);
  EXPECT_FALSE(json.contains("changes"));
  int num_phones = 0;
  for (const auto& pair : json.at("objects")) num_phones += pair.at("name") == "phone" ? 1 : 0;
  EXPECT_EQ(num_phones, 1);
}

}  // namespace
}  // namespace kintsugi::mapper
