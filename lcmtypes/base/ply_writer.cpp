#include "lcmtypes/base/ply_writer.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they are");

/// map.ply -> map.vertex.ply; AtomicFile writes it as map.vertex.partial.ply.
std::filesystem::path temporary_name(std::filesystem::path path, const std::string& element) {
  path.replace_filename(path.stem().string() + "." + element + path.extension().string());
  return path;
}

/// Copies records of this size; `select` is called with the bytes of some, and returns those at
/// their beginning that are written.
void copy(const std::filesystem::path& from, std::size_t record_bytes, std::ostream& to,
          const std::function<std::span<char>(std::span<char>)>& select) {
  constexpr std::size_t kRecords = 4096;
  std::ifstream in(from, std::ios::binary);
  std::vector<char> buffer(kRecords * record_bytes);
  while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), in.gcount() > 0) {
    const std::span<char> bytes =
        select(std::span(buffer).first(static_cast<std::size_t>(in.gcount())));
    to.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  if (!in.eof()) throw std::system_error(errno, std::generic_category(), from.string());
}

}  // namespace

PlyWriter::PlyWriter(const std::filesystem::path& path, std::vector<PlyElement> elements,
                     const std::vector<std::string>& comments)
    : path_(path), file_(path), comments_(comments) {
  for (const std::string& comment : comments) {
    require(comment.find_first_of("\r\n") == std::string::npos,
            path.string() + ": a comment for its header has several lines: '" + comment + "'");
  }
  const bool counts_are_known =
      std::ranges::all_of(elements, [](const PlyElement& e) { return e.count.has_value(); });
  for (PlyElement& element : elements) {
    List& list = lists_.emplace_back(List{std::move(element), 0, 0, nullptr});
    if (counts_are_known) {
      continue;
    }
    list.temporary = std::make_unique<AtomicFile>(temporary_name(path, list.element.name));
    list.temporary->stream();  // fails now when the folder cannot be written to
  }
  if (counts_are_known) write_header();
}

PlyWriter::~PlyWriter() = default;

void PlyWriter::write_record(std::size_t element, const char* record, std::size_t size) {
  List& list = lists_.at(element);
  AtomicFile& file = list.temporary ? *list.temporary : file_;
  file.stream().write(record, static_cast<std::streamsize>(size));
  ++list.count;
  list.record_bytes = size;
}

void PlyWriter::write_header() {
  std::ostream& out = file_.stream();
  out << "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments_) out << "comment " << comment << '\n';
  for (const List& list : lists_) {
    const std::int64_t count = list.element.count.value_or(list.count);
    out << "element " << list.element.name << ' ' << count << '\n';
    for (const std::string& property : list.element.properties) {
      out << "property " << property << '\n';
    }
  }
  out << "end_header\n";
}

void PlyWriter::commit(const Rewrite& rewrite) {
  for (const List& list : lists_) {
    if (list.count == list.element.count.value_or(list.count)) continue;
    throw std::logic_error("PlyWriter: " + std::to_string(list.count) + " records of element " +
                           list.element.name + " were appended, expected " +
                           std::to_string(*list.element.count));
  }
  if (std::ranges::any_of(lists_, [](const List& list) { return list.temporary != nullptr; })) {
    for (std::size_t i = 0; rewrite && i < lists_.size(); ++i) rewrite_records(i, rewrite);
    write_header();
    for (List& list : lists_) {
      list.temporary->stream().flush();
      copy(list.temporary->partial_path(), std::max<std::size_t>(list.record_bytes, 1),
           file_.stream(), [](std::span<char> bytes) { return bytes; });
      list.temporary.reset();
    }
  }
  file_.commit();
}

/// The header comes before the records and has their number: those that stay are written to another
/// temporary file first.
void PlyWriter::rewrite_records(std::size_t element, const Rewrite& rewrite) {
  List& list = lists_[element];
  list.temporary->stream().flush();
  auto kept = std::make_unique<AtomicFile>(temporary_name(path_, list.element.name + ".kept"));
  std::int64_t record = 0;
  std::int64_t num_kept = 0;
  copy(list.temporary->partial_path(), std::max<std::size_t>(list.record_bytes, 1), kept->stream(),
       [&](std::span<char> bytes) {
         std::size_t end = 0;
         for (std::size_t at = 0; at < bytes.size(); at += list.record_bytes) {
           const std::span<char> here = bytes.subspan(at, list.record_bytes);
           if (!rewrite(element, record++, here)) continue;
           std::ranges::copy(here, bytes.begin() + static_cast<std::ptrdiff_t>(end));
           end += list.record_bytes;
           ++num_kept;
         }
         return bytes.first(end);
       });
  list.temporary = std::move(kept);
  list.count = num_kept;
}

}  // namespace kintsugi
