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
  std::vector<std::int64_t> known_counts;
  for (PlyElement& element : elements) {
    known_counts.push_back(element.count.value_or(0));
    List& list = lists_.emplace_back(List{std::move(element), 0, 0, nullptr});
    if (counts_are_known) continue;
    list.temporary = std::make_unique<AtomicFile>(temporary_name(path, list.element.name));
    list.temporary->stream();  // fails now when the folder cannot be written to
  }
  if (counts_are_known) write_header(file_, known_counts);
}

PlyWriter::~PlyWriter() = default;

/// Then the records are in the file itself; or it is complete.
bool PlyWriter::counts_are_known() const {
  return std::ranges::all_of(lists_, [](const List& list) { return list.temporary == nullptr; });
}

void PlyWriter::append_records(std::size_t element, std::span<const char> records,
                               std::int64_t count) {
  List& list = lists_.at(element);
  AtomicFile& file = list.temporary ? *list.temporary : file_;
  file.stream().write(records.data(), std::ssize(records));
  list.count += count;
  if (count > 0) list.record_bytes = records.size() / static_cast<std::size_t>(count);
}

void PlyWriter::write_header(AtomicFile& file, const std::vector<std::int64_t>& counts) const {
  std::ostream& out = file.stream();
  out << "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments_) out << "comment " << comment << '\n';
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    out << "element " << lists_[i].element.name << ' ' << counts[i] << '\n';
    for (const std::string& property : lists_[i].element.properties) {
      out << "property " << property << '\n';
    }
  }
  out << "end_header\n";
}

std::vector<std::int64_t> PlyWriter::commit(const Rewrite& rewrite) {
  std::vector<std::int64_t> counts;
  for (const List& list : lists_) {
    counts.push_back(list.count);
    if (list.count == list.element.count.value_or(list.count)) continue;
    throw std::logic_error("PlyWriter: " + std::to_string(list.count) + " records of element " +
                           list.element.name + " were appended, expected " +
                           std::to_string(*list.element.count));
  }
  if (!counts_are_known()) {
    counts = write_all(file_, path_, rewrite);
    for (List& list : lists_) list.temporary.reset();
  }
  file_.commit();
  return counts;
}

std::vector<std::int64_t> PlyWriter::write_copy(const std::filesystem::path& path,
                                                const Rewrite& rewrite) {
  if (counts_are_known()) throw std::logic_error("PlyWriter: the records are in the file already");
  AtomicFile file(path);
  std::vector<std::int64_t> counts = write_all(file, path, rewrite);
  file.commit();
  return counts;
}

/// The header comes before the records and has their number: where some are dropped, those that
/// stay are written to another temporary file first.
std::vector<std::int64_t> PlyWriter::write_all(AtomicFile& file, const std::filesystem::path& path,
                                               const Rewrite& rewrite) {
  std::vector<std::int64_t> counts;
  std::vector<std::unique_ptr<AtomicFile>> kept;
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    List& list = lists_[i];
    list.temporary->stream().flush();
    counts.push_back(list.count);
    if (!rewrite) continue;
    kept.push_back(std::make_unique<AtomicFile>(temporary_name(path, list.element.name + ".kept")));
    counts.back() = write_kept(i, rewrite, *kept.back());
    kept.back()->stream().flush();
  }
  write_header(file, counts);
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    const AtomicFile& from = rewrite ? *kept[i] : *lists_[i].temporary;
    copy(from.partial_path(), std::max<std::size_t>(lists_[i].record_bytes, 1), file.stream(),
         [](std::span<char> bytes) { return bytes; });
  }
  return counts;
}

std::int64_t PlyWriter::write_kept(std::size_t element, const Rewrite& rewrite, AtomicFile& kept) {
  const List& list = lists_[element];
  std::int64_t record = 0;
  std::int64_t num_kept = 0;
  copy(list.temporary->partial_path(), std::max<std::size_t>(list.record_bytes, 1), kept.stream(),
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
  return num_kept;
}

}  // namespace kintsugi
