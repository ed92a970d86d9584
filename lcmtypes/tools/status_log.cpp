#include "lcmtypes/tools/status_log.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace kintsugi {
namespace {

constexpr const char* kHeader = "utime_us,process,field,value";

/// Between double quotes, as CSV requires it; each double quote inside is doubled.
std::string csv_text(std::string_view value) {
  std::string result = "\"";
  for (const char letter : value) result += letter == '"' ? "\"\"" : std::string(1, letter);
  return result + '"';
}
std::string csv_text(const std::string& value) { return csv_text(std::string_view(value)); }
std::string csv_text(TrackingState value) { return csv_text(to_string(value)); }
std::string csv_text(bool value) { return value ? "1" : "0"; }
std::string csv_text(double value) { return std::to_string(value); }
std::string csv_text(std::int32_t value) { return std::to_string(value); }
std::string csv_text(std::int64_t value) { return std::to_string(value); }

}  // namespace

StatusLog::StatusLog(const std::filesystem::path& path, double period_s)
    : path_(path), period_us_(1e6 * period_s) {
  std::string begin;
  const bool is_new = !std::getline(std::ifstream(path), begin);
  if (!is_new && begin != kHeader) {
    throw std::runtime_error(path.string() + ": is no log of statuses, which begins with " +
                             kHeader);
  }
  if (!write(is_new ? std::string(kHeader) + '\n' : "")) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
  }
}

StatusLog::~StatusLog() {
  for (const auto& [name, process] : processes_) write(process.waiting);
}

template <class Status>
void StatusLog::append(const Status& status) {
  std::ostringstream text;
  Status::visit_fields(
      [&](const StatusField& field, const auto& value) {
        if (field.name == std::string_view("utime")) return;  // has its own column
        text << status.utime << ',' << Status::kProcess << ',' << field.name << ','
             << csv_text(value) << '\n';
      },
      status);
  Process& process = processes_[Status::kProcess];
  process.waiting = text.str();
  const double since_us =
      static_cast<double>(status.utime) - static_cast<double>(process.written_utime);
  const bool is_set_back = since_us < 0.0;  // the clock of the sender: its next period begins now
  if (since_us < period_us_ && !is_set_back) return;
  write(process.waiting);
  process.waiting.clear();
  process.written_utime = status.utime;
}

/// Appends all of the text or nothing; false: nothing, and errno says why.
bool StatusLog::write(const std::string& text) const {
  // Opened anew each time: a stream keeps what it could not write, and writes it later.
  std::ofstream out(path_, std::ios::app);
  if (!out) return false;
  const auto size = static_cast<std::uintmax_t>(out.tellp());
  out << text;
  out.close();
  if (out) return true;
  const int reason = errno;
  std::error_code ignored;
  std::filesystem::resize_file(path_, size, ignored);
  errno = reason;
  return false;
}

template void StatusLog::append(const MapperStatus&);
template void StatusLog::append(const SegmenterStatus&);
template void StatusLog::append(const ViewerStatus&);
template void StatusLog::append(const DetectorStatus&);

}  // namespace kintsugi
