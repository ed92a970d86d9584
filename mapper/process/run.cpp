#include "mapper/process/run_mapper.hpp"

#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>

#include "mapper/process/linger.hpp"
#include "mapper/process/map_publisher.hpp"
#include "mapper/process/mapper_process.hpp"
#include "mapper/session/resumption.hpp"
#include "mapper/session/session_log.hpp"

namespace kintsugi::mapper {
namespace {

SessionLog::Config log_config(const Options& options) {
  SessionLog::Config config;
  config.resume = !options.resume_file.empty();
  config.path = config.resume ? options.resume_file : options.store_file;
  config.max_file_bytes = static_cast<std::int64_t>(1e6 * options.store_file_size_mb);
  return config;
}

/// Nothing to map: who missed something gets it.
void serve(const Options& options, SessionLog& log, const StoredSession& ended) {
  spdlog::info("session {} has ended: it is only served", ended.session);
  MapPublisher publisher(publisher_config(options, ended.session), log);
  MapperStatus status = ended.last_status.value_or(MapperStatus());
  status.device = options.source.device;
  status.finished = true;
  status.lingering = true;
  linger(publisher, options.linger_s, [&] { publisher.publish_status(status); });
}

/// What could be written by now is written.
void expect_complete(const SessionLog& log) {
  const SessionLog::Report report = log.report();
  if (report.waiting_bytes == 0 && report.lost_chunks == 0) return;
  throw std::runtime_error(
      "the log lacks what was published: " + std::to_string(report.waiting_bytes) + " bytes and " +
      std::to_string(report.lost_chunks) + " chunks had no room; see above");
}

}  // namespace

void run_mapper(const Options& options) {
  SessionLog log(log_config(options));
  Resumption resumption(log, options);
  if (const StoredSession* ended = resumption.ended_session()) {
    serve(options, log, *ended);
  } else {
    MapperProcess(options, log, resumption).run();
  }
  log.retry();
  if (!options.store_file.empty() || !options.resume_file.empty()) expect_complete(log);
}

}  // namespace kintsugi::mapper
