#pragma once
// Files are written while the work goes on.

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace kintsugi::segmenter {

/// Does jobs one after the other on a thread of its own: whoever hands one in waits for no disk.
///
/// A job takes the place of one of the same name that has not begun, so that the newest is done
/// and, however slow the disk, one job of a name waits. Safe for any number of threads.
class BackgroundWriter {
 public:
  using Job = std::function<void()>;  ///< must not throw

  BackgroundWriter();
  /// Does what was handed in.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  void put(const std::string& name, Job job);

  /// Waits until everything handed in is done.
  void wait();

 private:
  struct NamedJob {
    std::string name;
    Job job;
  };

  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<NamedJob> jobs_;  // that have not begun
  bool is_busy_ = false;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace kintsugi::segmenter
