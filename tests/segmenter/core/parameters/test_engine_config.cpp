#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gmock/gmock.h>

#include "segmenter/core/parameters/presets.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(EngineConfig, DefaultsAreThePapers) {
  const EngineConfig config;
  config.validate();
  EXPECT_EQ(config.threshold, 0.001);
  EXPECT_EQ(config.scale, 0.0005);
  EXPECT_EQ(config.beta, 0.85);
  EXPECT_EQ(config.radius_m(), 0.02F);
}

TEST(EngineConfig, NamesFieldValueAndBound) {
  const auto refused = [](EngineConfig config) { return [config] { config.validate(); }; };
  EXPECT_THAT(refused({.threshold = -0.5}),
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("threshold"), HasSubstr("-0.5"), HasSubstr("> 0"))));
  EXPECT_THAT(refused({.scale = 0.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("scale")));
  EXPECT_THAT(refused({.beta = 1.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("beta")));
  EXPECT_THAT(refused({.beta = 0.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("beta")));
  EXPECT_THAT(refused({.resolution_m = std::numeric_limits<double>::quiet_NaN()}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("resolution_m")));
  EXPECT_THAT(refused({.resolution_m = 1e-30}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("resolution_m")));
  EXPECT_THAT(refused({.radius_factor = std::numeric_limits<double>::infinity()}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("radius_factor")));
}

/// The default config, except that one parameter has this value.
EngineConfig with(const EngineParameter& parameter, double value) {
  EngineConfig config;
  config.*parameter.value = value;
  return config;
}

TEST(EngineConfig, ChecksEveryParameterOfTheTables) {
  const auto expect_checked = [](const EngineParameter& parameter) {
    EXPECT_THAT(([&] { with(parameter, -0.5).validate(); }),
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr(std::string(parameter.name) + " is -0.5"),
                          HasSubstr(std::string(parameter.bound.text)))));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(with(parameter, nan).validate(), std::invalid_argument) << parameter.name;
  };
  for (const EngineParameter& parameter : kMapParameters) expect_checked(parameter);
  for (const EngineParameter& parameter : kSpeedParameters) expect_checked(parameter);
}

TEST(EngineConfig, EveryParameterHasARowOfItsOwn) {
  std::set<std::string_view> names;
  EngineConfig config;
  for (double value = 1.0; const EngineParameter& parameter : kMapParameters) {
    names.insert(parameter.name);
    config.*parameter.value = value++;
  }
  for (double value = 1.0; const EngineParameter& parameter : kMapParameters) {
    EXPECT_EQ(config.*parameter.value, value++) << parameter.name << " is in another row, too";
  }
  EXPECT_EQ(names.size(), kMapParameters.size());
}

TEST(EngineConfig, EdgeWeightHasTheColorWeight) {
  EXPECT_EQ((EngineConfig{.color_weight = 0.25}.edge_weight().color_weight), 0.25);
}

TEST(Presets, PaperIsTheDefaultAndObjectsCountsColorAndFragments) {
  EXPECT_EQ(preset("paper").scale, EngineConfig().scale);
  EXPECT_EQ(preset("paper").min_points, 0.0);
  const EngineConfig objects = preset("objects");
  EXPECT_EQ(objects.threshold, 0.001);
  EXPECT_EQ(objects.scale, 0.002);
  EXPECT_EQ(objects.color_weight, 0.003);
  EXPECT_EQ(objects.min_points, 50.0);
  EXPECT_EQ(objects.radius_factor, 2.0);
}

}  // namespace
}  // namespace kintsugi::segmenter
