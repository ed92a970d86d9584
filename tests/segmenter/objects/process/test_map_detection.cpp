#include <gtest/gtest.h>

#include "segmenter/io/cloud_slices.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/process/map_detection.hpp"
#include "tests/segmenter/objects/library/example_object.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::example_object;

// All clouds have one session, so that it says nothing about their light.
TEST(ModelsOf, AreOfTheMapOfTheFirstLesson) {
  const kintsugi::testing::TemporaryFolder folder;
  KnownObject object = example_object("a_mug");
  write_object(object, folder.path());
  object.model.name = "b_cloud";
  object.lessons.front().map_session = kCloudSession;
  write_object(object, folder.path());
  object.model.name = "c_unknown";
  object.lessons.clear();
  write_object(object, folder.path());
  const std::vector<ObjectModel> models = models_of(ObjectLibrary::read(folder.path()));
  ASSERT_EQ(models.size(), 3U);
  EXPECT_EQ(models[0].map_session, 77);
  EXPECT_EQ(models[1].map_session, 0);
  EXPECT_EQ(models[2].map_session, 0);
}

}  // namespace
}  // namespace kintsugi::segmenter
