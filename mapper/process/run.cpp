#include "mapper/process/run.hpp"

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <tbb/global_control.h>

#include "lcmtypes/base/logger.hpp"
#include "mapper/process/linger.hpp"
#include "mapper/process/map_name_claim.hpp"
#include "mapper/process/map_publisher.hpp"
#include "mapper/process/mapper_process.hpp"
#include "mapper/process/output_files.hpp"
#include "mapper/session/resumption.hpp"
#include "mapper/session/session_store.hpp"

namespace kintsugi::mapper {
namespace {

SessionStore::Config store_config(const Options& options) {
  SessionStore::Config config;
  config.resume = !options.resume_file.empty();
  config.path = config.resume ? options.resume_file : options.store_file;
  config.durable = options.durable;
  config.max_file_bytes = static_cast<std::int64_t>(1e6 * options.store_file_size_mb);
  config.max_total_bytes = static_cast<std::int64_t>(1e6 * options.store_limit_mb);
  return config;
}

/// For a session that is complete: answers requests for its slices.
void resend_only(const Options& options, SessionStore& store, const StoredSession& ended) {
  spdlog::info("session {} is complete: its slices are only sent again", ended.session);
  warn_of_missing_files(options);
  MapPublisher publisher(publisher_config(options, ended.session), store);
  MapperStatus status = ended.last_status.value_or(MapperStatus());
  status.device = options.source.device;
  status.finished = true;
  status.lingering = true;
  linger(publisher, options.linger_s, [&] { publisher.publish_status(status); });
}

/// @throws std::runtime_error unless everything that was published is in the log
void expect_complete(const SessionStore& store) {
  const BufferedLog::Report report = store.report();
  if (report.waiting_bytes == 0 && report.lost_chunks == 0) return;
  throw std::runtime_error(
      "the log is incomplete, see above: " + std::to_string(report.waiting_bytes) + " bytes and " +
      std::to_string(report.lost_chunks) + " chunks could not be written");
}

}  // namespace

void run(const Options& options) {
  std::unique_ptr<tbb::global_control> thread_limit;
  if (options.threads > 0) {
    thread_limit = std::make_unique<tbb::global_control>(
        tbb::global_control::max_allowed_parallelism, options.threads);
  }
  std::optional<MapNameClaim> claim(std::in_place, options.lcm_url, options.map_name);
  SessionStore store(store_config(options));
  Resumption resumption(store, {.options = mapping_options(options),
                                .session = options.session,
                                .max_range_m = options.source.max_range_m});
  if (const StoredSession* ended = resumption.ended_session()) {
    resend_only(options, store, *ended);
  } else {
    MapperProcess process(options, store, resumption);
    claim.reset();  // from now on its heartbeats tell that it runs
    process.run();
  }
  store.finish();
  if (!options.store_file.empty() || !options.resume_file.empty()) expect_complete(store);
}

}  // namespace kintsugi::mapper
