#include "tests/support/power_cut.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/child_program.hpp"

namespace kintsugi::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kNone = -1;

/// Begins as a datagram of LCM does.
const std::string kTold = "LC02 told ";

/// A change of the size of a file, and perhaps of its contents.
struct Change {
  std::int64_t number;  ///< of the event
  bool is_written;      ///< else shortened, or made longer
  std::size_t offset;
  std::string_view text;
};

/// Of one or two names at once.
struct NameChange {
  std::int64_t number;  ///< of the event
  struct Name {
    int folder;
    std::string name;
    int node;
  };
  std::vector<Name> names;
};

struct Node {
  bool is_folder = false;
  std::string content;               ///< on the disk
  std::vector<Change> pending;       ///< not on the disk
  std::map<std::string, int> names;  ///< of a folder, on the disk
  std::map<std::string, int> seen;   ///< of a folder, as the program sees them
};

void apply(const Change& change, std::string& content) {
  if (!change.is_written) return content.resize(change.offset);
  content.resize(std::max(content.size(), change.offset + change.text.size()));
  content.replace(change.offset, change.text.size(), change.text);
}

class Disk {
 public:
  Disk(std::uint32_t seed, const fs::path& before) : random_(seed) {
    nodes_[0].is_folder = true;
    if (!before.empty()) add_found(0, before);
  }

  void note(const DiskEvent& event, std::int64_t number);
  void cut();
  void write(const fs::path& to, int folder = 0);

 private:
  void add_found(int folder, const fs::path& from);
  int node_of(int number) const { return number == 0 ? 0 : numbers_.at({program_, number}); }
  int find(const std::string& path) const;
  void make(const DiskRecord& record, const std::string& name, std::int64_t number);
  void rename(const DiskRecord& record, std::string_view text, std::int64_t number);
  void change(NameChange change);
  void sync(int node, std::int64_t begun);
  void fail(int node, std::int64_t begun);
  void apply(const NameChange& change);
  void keep_some(std::vector<Change> changes, std::string& content);
  void keep_sectors(const std::vector<Change>& changes, std::string& content);
  int roll(int sides) { return static_cast<int>(random_() % static_cast<unsigned>(sides)); }

  std::mt19937 random_;
  std::map<int, Node> nodes_;
  std::map<std::pair<int, int>, int> numbers_;  ///< program, number in its journal -> in nodes_
  int program_ = 0;                             ///< of the event that is noted
  std::vector<NameChange> name_changes_;
  int next_ = 1;
};

void Disk::add_found(int folder, const fs::path& from) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    const int node = next_++;
    nodes_[node].is_folder = entry.is_directory();
    nodes_[folder].names[name] = nodes_[folder].seen[name] = node;
    if (entry.is_directory()) {
      add_found(node, entry.path());
    } else {
      std::ifstream in(entry.path(), std::ios::binary);
      nodes_[node].content.assign(std::istreambuf_iterator<char>(in), {});
    }
  }
}

/// What the programs see there.
int Disk::find(const std::string& path) const {
  int node = 0;
  for (const fs::path& name : fs::path(path)) node = nodes_.at(node).seen.at(name.string());
  return node;
}

void Disk::note(const DiskEvent& event, std::int64_t number) {
  const DiskRecord& record = event.record;
  const std::string text(event.text);
  program_ = event.program;
  switch (record.action) {
    case DiskAction::kFound:
      numbers_[{program_, record.node}] = find(text);
      return;
    case DiskAction::kMadeFile:
    case DiskAction::kMadeFolder:
      return make(record, text, number);
    case DiskAction::kRemoved:
      return change({number, {{node_of(record.folder), text, kNone}}});
    case DiskAction::kRenamed:
    case DiskAction::kExchanged:
      return rename(record, text, number);
    case DiskAction::kWritten:
    case DiskAction::kShortened:
      nodes_.at(node_of(record.node))
          .pending.push_back({number, record.action == DiskAction::kWritten,
                              static_cast<std::size_t>(record.offset), event.text});
      return;
    case DiskAction::kSyncDone:
      return sync(node_of(record.node), record.offset);
    case DiskAction::kSyncFailed:
      return fail(node_of(record.node), record.offset);
    case DiskAction::kSyncBegun:
    case DiskAction::kSent:
      return;
  }
}

void Disk::make(const DiskRecord& record, const std::string& name, std::int64_t number) {
  const int node = next_++;
  numbers_[{program_, record.node}] = node;
  nodes_[node].is_folder = record.action == DiskAction::kMadeFolder;
  change({number, {{node_of(record.folder), name, node}}});
}

void Disk::rename(const DiskRecord& record, std::string_view text, std::int64_t number) {
  const std::string from(text.substr(0, text.find('\0')));
  const std::string to(text.substr(text.find('\0') + 1));
  const int from_folder = node_of(record.folder);
  const int to_folder = node_of(record.to_folder);
  const bool exchanges = record.action == DiskAction::kExchanged;
  const int moved = nodes_.at(from_folder).seen.at(from);
  const int other = exchanges ? nodes_.at(to_folder).seen.at(to) : kNone;
  change({number, {{from_folder, from, other}, {to_folder, to, moved}}});
}

void Disk::change(NameChange change) {
  for (const auto& [folder, name, node] : change.names) nodes_.at(folder).seen[name] = node;
  name_changes_.push_back(std::move(change));
}

/// Puts on the disk what came before event `begun`.
void Disk::sync(int number, std::int64_t begun) {
  Node& node = nodes_.at(number);
  const auto is_before = [begun](const auto& change) { return change.number < begun; };
  for (const Change& change : node.pending) {
    if (is_before(change)) testing::apply(change, node.content);
  }
  std::erase_if(node.pending, is_before);
  const auto is_of_folder = [&](const NameChange& change) {
    return is_before(change) && std::ranges::any_of(change.names, [&](const auto& name) {
             return name.folder == number;
           });
  };
  for (const NameChange& change : name_changes_) {
    if (is_of_folder(change)) apply(change);
  }
  std::erase_if(name_changes_, is_of_folder);
}

void Disk::fail(int number, std::int64_t begun) {
  Node& node = nodes_.at(number);
  std::vector<Change> lost;
  std::ranges::copy_if(node.pending, std::back_inserter(lost),
                       [begun](const Change& change) { return change.number < begun; });
  std::erase_if(node.pending, [begun](const Change& change) { return change.number < begun; });
  keep_sectors(lost, node.content);
}

void Disk::apply(const NameChange& change) {
  for (const auto& [folder, name, node] : change.names) {
    if (node == kNone) {
      nodes_.at(folder).names.erase(name);
    } else {
      nodes_.at(folder).names[name] = node;
    }
  }
}

void Disk::cut() {
  const bool in_order = roll(2) == 0;
  const auto num_left = static_cast<std::size_t>(roll(static_cast<int>(name_changes_.size()) + 1));
  for (std::size_t i = 0; i < name_changes_.size(); ++i) {
    if (in_order ? i < num_left : roll(2) == 0) apply(name_changes_[i]);
  }
  for (auto& [number, node] : nodes_) keep_some(std::move(node.pending), node.content);
}

void Disk::keep_some(std::vector<Change> changes, std::string& content) {
  if (changes.empty()) return;
  const int how = roll(4);
  if (how == 0) return;  // nothing
  if (how == 1) return keep_sectors(changes, content);
  // All, or some in their order, of which the last is torn.
  const int num_left =
      how == 2 ? static_cast<int>(changes.size()) : roll(static_cast<int>(changes.size())) + 1;
  for (int i = 0; i < num_left; ++i) {
    Change& change = changes[static_cast<std::size_t>(i)];
    if (how == 3 && i + 1 == num_left && change.is_written) {
      const std::size_t end =
          (change.offset +
           static_cast<std::size_t>(roll(static_cast<int>(change.text.size()) + 1))) /
          512 * 512;
      if (end <= change.offset) return;
      change.text = change.text.substr(0, end - change.offset);
    }
    testing::apply(change, content);
  }
}

/// Sectors by chance, and a size that the file has had meanwhile.
void Disk::keep_sectors(const std::vector<Change>& changes, std::string& content) {
  const std::size_t sector = roll(2) == 0 ? 512 : 4'096;
  std::vector<std::size_t> sizes{content.size()};
  std::string all = content;
  for (const Change& change : changes) {
    testing::apply(change, all);
    sizes.push_back(all.size());
  }
  const std::size_t size = sizes[static_cast<std::size_t>(roll(static_cast<int>(sizes.size())))];
  content.resize(std::max(size, content.size()));
  for (const Change& change : changes) {
    if (!change.is_written) continue;
    const std::size_t end = change.offset + change.text.size();
    for (std::size_t at = change.offset; at < end;) {
      const std::size_t next = std::min(end, (at / sector + 1) * sector);
      if (roll(2) == 0) {
        content.resize(std::max(content.size(), next));
        content.replace(at, next - at, change.text.substr(at - change.offset, next - at));
      }
      at = next;
    }
  }
  content.resize(size);
}

void Disk::write(const fs::path& to, int folder) {
  fs::create_directories(to);
  for (const auto& [name, number] : nodes_.at(folder).names) {
    const Node& node = nodes_.at(number);
    if (node.is_folder) {
      write(to / name, number);
    } else {
      std::ofstream(to / name, std::ios::binary) << node.content;
    }
  }
}

/// Of the programs that were told to write into `file`.
std::vector<fs::path> journals(const fs::path& file) {
  std::vector<fs::path> found;
  const std::string begin = file.filename().string() + ".";
  for (const auto& entry : fs::directory_iterator(file.parent_path())) {
    if (entry.path().filename().string().starts_with(begin)) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

DiskJournal::DiskJournal(const fs::path& file) {
  for (const fs::path& journal : journals(file)) read(journal);
  if (bytes_.empty()) throw std::runtime_error("there is no journal " + file.string());
  sort();
}

void DiskJournal::read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const int program = static_cast<int>(bytes_.size());
  const std::string_view bytes =
      bytes_.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  for (std::size_t at = 0; at + sizeof(DiskRecord) <= bytes.size();) {
    DiskEvent event;
    event.program = program;
    std::memcpy(&event.record, bytes.data() + at, sizeof(DiskRecord));
    at += sizeof(DiskRecord);
    event.text = bytes.substr(at, event.record.text_bytes);
    at += event.record.text_bytes;
    events_.push_back(event);
  }
}

void DiskJournal::sort() {
  std::ranges::stable_sort(events_, {},
                           [](const DiskEvent& event) { return event.record.time_us; });
  std::vector<std::vector<std::int64_t>> numbers(bytes_.size());  // by program: in events_
  for (std::size_t i = 0; i < events_.size(); ++i) {
    DiskEvent& event = events_[i];
    auto& its_numbers = numbers[static_cast<std::size_t>(event.program)];
    its_numbers.push_back(static_cast<std::int64_t>(i));
    const DiskAction action = event.record.action;
    if (action != DiskAction::kSyncDone && action != DiskAction::kSyncFailed) continue;
    event.record.offset = its_numbers.at(static_cast<std::size_t>(event.record.offset));
  }
}

void cut_power(std::span<const DiskEvent> events, const fs::path& before, std::uint32_t seed,
               const fs::path& to) {
  Disk disk(seed, before);
  for (std::size_t i = 0; i < events.size(); ++i)
    disk.note(events[i], static_cast<std::int64_t>(i));
  disk.cut();
  fs::remove_all(to);
  disk.write(to);
}

std::vector<std::string> forgetful_disk(const fs::path& folder, const fs::path& journal) {
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& file : journals(journal)) fs::remove(file);
  const char* sanitizer = std::getenv("ASAN_OPTIONS");
  return {"LD_PRELOAD=" + (here / "libforgetful_disk.so").string(),
          "ASAN_OPTIONS=" + (sanitizer == nullptr ? "" : sanitizer + std::string(":")) +
              "verify_asan_link_order=0",
          "FORGETFUL_DISK=" + fs::canonical(folder).string(),
          "FORGETFUL_JOURNAL=" + journal.string()};
}

int run_on_forgetful_disk(const std::string& test, const fs::path& folder,
                          const fs::path& journal) {
  std::vector<std::string> words = forgetful_disk(folder, journal);
  words.insert(words.end(), {fs::read_symlink("/proc/self/exe"), "--gtest_filter=" + test,
                             "--gtest_also_run_disabled_tests"});
  return ChildProgram("/usr/bin/env", words, folder.string() + ".txt").wait();
}

void tell_others(int number) {
  std::array<int, 2> sockets{};
  if (socketpair(AF_UNIX, SOCK_DGRAM, 0, sockets.data()) != 0) std::abort();
  std::string text = kTold + std::to_string(number);
  iovec part{text.data(), text.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  (void)sendmsg(sockets[0], &message, 0);
  for (const int socket : sockets) close(socket);
}

int last_told(std::span<const DiskEvent> events) {
  int number = 0;
  for (const DiskEvent& event : events) {
    if (event.record.action == DiskAction::kSent && event.text.starts_with(kTold)) {
      number = std::stoi(std::string(event.text.substr(kTold.size())));
    }
  }
  return number;
}

}  // namespace kintsugi::testing
