#pragma once
// A thread that writes files, so that nobody waits for the disk.

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace kintsugi::segmenter {

/// Does jobs one after the other in a thread of its own.
///
/// A new job replaces one of the same name that has not begun. However slow the disk, at most one
/// job of a name is waiting, and it is the newest. Safe for any number of threads.
class BackgroundWriter {
 public:
  using Job = std::function<void()>;  ///< must not throw

  BackgroundWriter();
  /// Finishes all jobs.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  void put(const std::string& name, Job job);

  /// Waits until all jobs are done.
  void wait();

 private:
  struct NamedJob {
    std::string name;
    Job job;
  };

  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<NamedJob> jobs_;  // not begun
  bool is_busy_ = false;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace kintsugi::segmenter
