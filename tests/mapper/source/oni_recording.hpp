#pragma once
// A .oni file as openni::Recorder writes it.

#include <filesystem>
#include <string>
#include <thread>

#include "mapper/source/openni2/oni_file.hpp"
#include "tests/mapper/openni2_driver/openni2_client.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper::test {

/// Records every frame of `folder` to `file`, depth and colour without loss.
inline void record_oni(const RecordingFolder& folder, const std::filesystem::path& file) {
  const OpenNi2Session session;
  Client client(folder.uri());
  ASSERT_TRUE(client.is_open()) << client.error();
  openni::Recorder recorder;
  ASSERT_EQ(recorder.create(file.c_str()), openni::STATUS_OK);
  ASSERT_EQ(recorder.attach(client.depth(), false), openni::STATUS_OK);
  ASSERT_EQ(recorder.attach(client.color(), false), openni::STATUS_OK);
  ASSERT_EQ(recorder.start(), openni::STATUS_OK);
  // start() only posts a message to the recorder's thread; that the file stops growing is the only
  // sign that it was heard.
  std::uintmax_t size = 0;
  for (int unchanged = 0; unchanged < 10;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const std::uintmax_t now = std::filesystem::file_size(file);
    unchanged = now > 0 && now == size ? unchanged + 1 : 0;
    size = now;
  }
  client.start(-1.0F);
  client.read_all(1000, kNumFrames);
  ASSERT_EQ(client.depth_frames.size(), kNumFrames);
  recorder.stop();
  recorder.destroy();
}

}  // namespace kintsugi::mapper::test
