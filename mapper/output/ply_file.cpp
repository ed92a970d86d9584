#include "mapper/output/ply_file.hpp"

#include <bit>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace kintsugi::mapper {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they are");

/// map.ply -> map.vertex.ply, which AtomicFile gives yet another name.
std::filesystem::path list_name(std::filesystem::path path, const std::string& element) {
  path.replace_filename(path.stem().string() + "." + element + path.extension().string());
  return path;
}

void copy(const std::filesystem::path& from, std::ostream& to) {
  std::ifstream in(from, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 16U);
  while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), in.gcount() > 0) {
    to.write(buffer.data(), in.gcount());
  }
  if (!in.eof()) throw std::system_error(errno, std::generic_category(), from.string());
}

}  // namespace

struct PlyFile::List {
  PlyElement element;
  AtomicFile file;  ///< never committed: it goes with the object
  std::int64_t count = 0;
};

PlyFile::PlyFile(const std::filesystem::path& path, std::vector<PlyElement> elements,
                 std::vector<std::string> comments)
    : path_(path), comments_(std::move(comments)) {
  for (const std::string& comment : comments_) {
    if (comment.find_first_of("\r\n") != std::string::npos) {
      throw std::invalid_argument(path.string() + ": a comment in its header has several lines: '" +
                                  comment + "'");
    }
  }
  AtomicFile check(path);
  for (PlyElement& element : elements) {
    const std::filesystem::path name = list_name(path, element.name);
    lists_.push_back(std::unique_ptr<List>(new List{std::move(element), AtomicFile(name)}));
    lists_.back()->file.stream();  // a folder that cannot be written to is known at once
  }
}

PlyFile::~PlyFile() = default;

void PlyFile::append(std::size_t element, std::span<const std::byte> records, std::int64_t count) {
  List& list = *lists_.at(element);
  list.file.stream().write(reinterpret_cast<const char*>(records.data()),
                           static_cast<std::streamsize>(records.size()));
  list.count += count;
}

void PlyFile::commit() {
  AtomicFile file(path_);
  std::ostream& out = file.stream();
  out << "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments_) out << "comment " << comment << '\n';
  for (const auto& list : lists_) {
    out << "element " << list->element.name << ' ' << list->count << '\n';
    for (const std::string& property : list->element.properties) {
      out << "property " << property << '\n';
    }
  }
  out << "end_header\n";
  for (const auto& list : lists_) {
    list->file.stream().flush();
    copy(list->file.partial_path(), out);
  }
  file.commit();
  lists_.clear();
}

}  // namespace kintsugi::mapper
