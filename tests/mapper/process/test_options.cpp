#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/fusion/truncation.hpp"
#include "tests/mapper/process/parsed_options.hpp"

namespace kintsugi::mapper {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::options_of;
using testing::parse;
using testing::TemporaryFile;

TEST(Options, DefaultsAreTheDesigns) {
  const Options options = options_of({});
  EXPECT_EQ(options.pipeline.volume.region, RegionShape::kBall);
  EXPECT_DOUBLE_EQ(options.pipeline.volume.volume_size_m, 4.5);
  EXPECT_EQ(options.pipeline.volume.resolution_m, 4.5 / 512);
  EXPECT_EQ(options.pipeline.volume.shift_vox, 14);
  EXPECT_EQ(options.pipeline.slices.extractor.weight_threshold, 8);
  EXPECT_EQ(options.session, 0) << "by the clock, or of the log that is resumed";
  EXPECT_DOUBLE_EQ(options.rate_mb_s, 10.0);
  EXPECT_DOUBLE_EQ(options.linger_s, 2.0);
  EXPECT_FALSE(options.source.replay);
}

TEST(Options, ALimitOfTheLogCannotBeKeptWithEveryFrame) {
  EXPECT_DOUBLE_EQ(options_of({"--store-limit", "500"}).store_limit_mb, 500.0);
  EXPECT_THAT(error_of({"--store-limit", "500", "--store-frames"}),
              HasSubstr("--store-limit cannot be kept with --store-frames"));
  EXPECT_THAT(error_of({"--store-limit", "-1"}), HasSubstr("--store-limit"));
}

TEST(Options, TakesEveryFlag) {
  const Options options = options_of({"--device",
                                      "folder:///data/x",
                                      "--calibration",
                                      "camera.txt",
                                      "--volume-size",
                                      "6",
                                      "--shift",
                                      "20",
                                      "--min-weight",
                                      "4",
                                      "--output-trajectory",
                                      "out.txt",
                                      "--timings",
                                      "frames.csv",
                                      "--max-frames",
                                      "9",
                                      "--publish-frames",
                                      "--replay",
                                      "--lcm-url",
                                      "memq://",
                                      "--map-name",
                                      "attic",
                                      "--session",
                                      "77",
                                      "--threads",
                                      "2"});
  EXPECT_EQ(options.source.device, "folder:///data/x");
  EXPECT_EQ(options.source.calibration_file, "camera.txt");
  EXPECT_TRUE(options.source.replay);
  EXPECT_EQ(options.source.lcm_url, "memq://");
  EXPECT_DOUBLE_EQ(options.pipeline.volume.volume_size_m, 6.0);
  EXPECT_EQ(options.pipeline.volume.resolution_m, 4.5 / 512) << "does not follow the size";
  EXPECT_EQ(options.pipeline.volume.shift_vox, 20);
  EXPECT_EQ(options.pipeline.slices.extractor.weight_threshold, 4);
  EXPECT_EQ(options.output_path_file, "out.txt");
  EXPECT_EQ(options.timings_file, "frames.csv");
  EXPECT_EQ(options.max_frames, 9);
  EXPECT_TRUE(options.publish_frames);
  EXPECT_EQ(options.map_name, "attic");
  EXPECT_EQ(options.session, 77);
  EXPECT_EQ(options.threads, 2);
  EXPECT_DOUBLE_EQ(options_of({"--resolution", "0.01"}).pipeline.volume.resolution_m, 0.01);
}

TEST(Options, TakesTheFlagsOfCameras) {
  const SourceConfig camera =
      options_of({"--depth-mode", "320x240@60", "--color-mode", "1280x1024", "--assume-registered",
                  "--lock-exposure", "2", "--device-silence", "3", "--reconnect", "60",
                  "--max-range", "4"})
          .source;
  EXPECT_EQ(camera.depth_mode, "320x240@60");
  EXPECT_EQ(camera.color_mode, "1280x1024");
  EXPECT_TRUE(camera.assume_registered);
  EXPECT_EQ(camera.lock_exposure_after_s, 2.0);
  EXPECT_DOUBLE_EQ(camera.device_silence_s, 3.0);
  EXPECT_DOUBLE_EQ(camera.reconnect_s, 60.0);
  EXPECT_DOUBLE_EQ(camera.max_range_m, 4.0);
  EXPECT_FALSE(options_of({}).source.lock_exposure_after_s);
  EXPECT_THAT(error_of({"--depth-mode", "big"}), HasSubstr("depth_mode"));
  EXPECT_THAT(error_of({"--cloud", "a.ply", "--mesh", "a.ply"}),
              HasSubstr("--mesh is a.ply, the same file as that of --cloud"));
  EXPECT_THAT(error_of({"--store", "./a.lcm", "--timings", "a.lcm"}),
              HasSubstr("--store is ./a.lcm, the same file as that of --timings"));
  EXPECT_THAT(error_of({"--cloud", "none/such/a.ply"}),
              HasSubstr("none/such/a.ply: there is no folder none/such"));
  EXPECT_THAT(error_of({"--output-trajectory", "/tmp"}), HasSubstr("/tmp: is a folder"));
  EXPECT_THAT(error_of({"--lock-exposure", "nan"}), HasSubstr("--lock-exposure is nan"));
}

TEST(Options, ReadsAConfigurationFileUnderTheFlags) {
  const TemporaryFile file("volume-size=3\nmap-name=\"cellar\"\nresolution=0.02\n");
  const Options options = options_of({"--config", file.path().c_str(), "--map-name", "attic"});
  EXPECT_DOUBLE_EQ(options.pipeline.volume.volume_size_m, 3.0);
  EXPECT_DOUBLE_EQ(options.pipeline.volume.resolution_m, 0.02);
  EXPECT_EQ(options.map_name, "attic");
}

TEST(Options, WhatIsPrintedCanBeReadBack) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(std::get<int>(parse({"--volume-size", "3.5", "--print-config"})), 0);
  const TemporaryFile file(::testing::internal::GetCapturedStdout());
  const Options options = options_of({"--config", file.path().c_str()});
  EXPECT_DOUBLE_EQ(options.pipeline.volume.volume_size_m, 3.5);
  EXPECT_EQ(options.pipeline.volume.resolution_m, 4.5 / 512);
}

TEST(Options, ChooseTheVolume) {
  const Options cube = options_of({"--volume", "cube"});
  EXPECT_EQ(cube.pipeline.volume.region, RegionShape::kCube);
  EXPECT_DOUBLE_EQ(cube.pipeline.volume.volume_size_m, 4.5);
  EXPECT_DOUBLE_EQ(cube.source.max_range_m, 6.5);
  EXPECT_EQ(options_of({"--volume-size", "3"}).pipeline.volume.region, RegionShape::kCube);
  EXPECT_THAT(error_of({"--volume", "range", "--volume-size", "3"}),
              HasSubstr("--volume-size is for --volume cube, --volume is 'range'"));
  EXPECT_THAT(error_of({"--volume", "ball"}),
              HasSubstr("--volume is 'ball', must be range or cube"));
}

TEST(Options, TheVolumeReachesAsFarAsDepthIsUsed) {
  const Options options = options_of({"--max-range", "4"});
  EXPECT_DOUBLE_EQ(options.source.max_range_m, 4.0);
  EXPECT_DOUBLE_EQ(options.pipeline.volume.max_range_m, 4.0);
  EXPECT_DOUBLE_EQ(options.pipeline.integrator.max_depth_m, 4.0);
  EXPECT_GE(options.pipeline.raycaster.max_depth_m, 4.0);
  EXPECT_THAT(error_of({"--max-range", "9"}), HasSubstr("--max-range is 9, must be "));
}

TEST(Options, TheRangeEndsWhereDepthIsTooNoisyOrTheVolumeEnds) {
  // As far as the largest truncation distance, 16 voxels, is two deviations of the depth.
  const double range_m = options_of({"--resolution", "0.006"}).source.max_range_m;
  EXPECT_NEAR(kRangeSigmas * DepthNoise().sigma_m(range_m), 16 * 0.006, 1e-9);
  const double noisy_m = options_of({"--depth-noise", "0.002,0.01,0.003"}).source.max_range_m;
  const DepthNoise noisy{.base_m = 0.002, .share = 0.01, .growth_per_m = 0.003};
  EXPECT_NEAR(kRangeSigmas * noisy.sigma_m(noisy_m), 16 * 4.5 / 512, 1e-9);
  EXPECT_LT(options_of({"--resolution", "0.003"}).source.max_range_m, 3.2) << "the volume ends";
  EXPECT_DOUBLE_EQ(options_of({}).source.max_range_m, 6.5) << "the reach of 16 bits of 0.1 mm";
  EXPECT_DOUBLE_EQ(options_of({"--resolution", "0.02"}).source.max_range_m, 6.5);
}

TEST(Options, NamesWhatIsWrong) {
  EXPECT_THAT(error_of({"--max-frames", "-1"}), HasSubstr("--max-frames is -1"));
  EXPECT_THAT(error_of({"--volume-size", "-4"}), HasSubstr("--volume-size is -4"));
  EXPECT_THAT(error_of({"--volume-size", "nan"}), HasSubstr("--volume-size is nan"));
  EXPECT_THAT(error_of({"--volume-memory", "0"}), HasSubstr("--volume-memory is 0, must be"));
  EXPECT_THAT(error_of({"--kept-memory", "-1"}), HasSubstr("--kept-memory is -1, must be"));
  EXPECT_THAT(error_of({"--min-weight", "-1"}), HasSubstr("--min-weight is -1, must be"));
  EXPECT_THAT(error_of({"--device-silence", "0"}), HasSubstr("--device-silence is 0, must be"));
  EXPECT_THAT(error_of({"--lock-exposure", "-2"}), HasSubstr("--lock-exposure is -2, must be"));
  // What follows from them is not named instead.
  for (const char* shift : {"1000", "2000000000"}) {
    EXPECT_THAT(error_of({"--shift", shift}), HasSubstr(std::string("--shift is ") + shift));
  }
  EXPECT_THAT(error_of({"--resolution", "1e-9"}), HasSubstr("--resolution is 1e-09, must be"));
  EXPECT_THAT(error_of({"--store-frames"}), HasSubstr("--store-frames needs --store FILE"));
  EXPECT_THAT(error_of({"--map-name", ""}), HasSubstr("--map-name has 0 bytes"));
  EXPECT_THAT(error_of({"--join", "map"}), HasSubstr("it names the map of another mapper"));
  EXPECT_THAT(error_of({"--join", "other", "--slices", "shift"}),
              HasSubstr("--join needs a map that is corrected by loops"));
  EXPECT_THAT(error_of({"--join", "other", "--no-loop-closure"}), HasSubstr("--join needs"));
  EXPECT_THAT(error_of({"--session", "-5"}), HasSubstr("--session is -5"));
  EXPECT_THAT(error_of({"--trajectory", "/no/such/file"}),
              HasSubstr("/no/such/file: No such file or directory"));
  EXPECT_THAT(error_of({"--device", "a.oni", "--ground-truth", "dir"}),
              HasSubstr("--ground-truth is for synthetic:// devices, --device is 'a.oni'"));
}

TEST(Options, UnknownFlagsAndTextForNumbersEndTheProcess) {
  EXPECT_NE(std::get<int>(parse({"--no-such-flag"})), 0);
  EXPECT_NE(std::get<int>(parse({"--volume-size", "big"})), 0);
}

TEST(Options, PassesTheFolderForTheTruthToTheDevice) {
  EXPECT_EQ(options_of({"--device", "synthetic://office", "--ground-truth", "d"}).source.device,
            "synthetic://office?ground_truth=d");
  EXPECT_EQ(
      options_of({"--device", "synthetic://office?noise=0", "--ground-truth", "d"}).source.device,
      "synthetic://office?noise=0&ground_truth=d");
}

TEST(Options, ReadsTheGivenPath) {
  const TemporaryFile good("1.0 1 2 3 0 0 0 1\n");
  EXPECT_EQ(options_of({"--trajectory", good.path().c_str()}).pipeline.given_path.size(), 1U);
}

TEST(Options, NamesFileAndLineOfABadPath) {
  const TemporaryFile bad("1.0 1 2 3 0 0 0 1\n2.0 1 2\n");
  EXPECT_THAT(error_of({"--trajectory", bad.path().c_str()}),
              HasSubstr(bad.path() + ":2: 3 fields"));
}

}  // namespace
}  // namespace kintsugi::mapper
