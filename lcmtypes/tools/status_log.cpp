#include "lcmtypes/tools/status_log.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kintsugi {
namespace {

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

StatusLog::StatusLog(const std::filesystem::path& path) : out_(path, std::ios::app) {
  if (out_ && out_.tellp() == 0) out_ << "utime_us,process,field,value" << std::endl;
  if (!out_) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
  }
}

template <class Status>
void StatusLog::append(const Status& status) {
  Status::visit_fields(
      [&](const StatusField& field, const auto& value) {
        if (field.name == std::string_view("utime")) return;  // has its own column
        out_ << status.utime << ',' << Status::kProcess << ',' << field.name << ','
             << csv_text(value) << '\n';
      },
      status);
  out_.flush();
}

template void StatusLog::append(const MapperStatus&);
template void StatusLog::append(const SegmenterStatus&);
template void StatusLog::append(const ViewerStatus&);
template void StatusLog::append(const DetectorStatus&);

}  // namespace kintsugi
