#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace kintsugi::viewer {

/// Values by key that remember as of which version they are, so that a reader that knows an earlier
/// version gets only what has changed since. A key that was removed is remembered, too.
template <class Key, class Value>
class VersionedMap {
 public:
  void set(const Key& key, Value value, std::uint64_t version) {
    entries_.insert_or_assign(key, Entry{std::move(value), version});
  }
  /// Nothing happens when the key is not here.
  void remove(const Key& key, std::uint64_t version) {
    const auto found = entries_.find(key);
    if (found != entries_.end() && found->second.value) found->second = {std::nullopt, version};
  }

  /// nullptr: not here.
  const Value* find(const Key& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() || !found->second.value ? nullptr : &*found->second.value;
  }

  /// Calls function(key, const Value*) for what is newer than `since`; nullptr: it was removed.
  template <class Function>
  void for_each_since(std::uint64_t since, Function&& function) const {
    for (const auto& [key, entry] : entries_) {
      if (entry.version > since) function(key, entry.value ? &*entry.value : nullptr);
    }
  }

  void clear() { entries_.clear(); }

 private:
  struct Entry {
    std::optional<Value> value;
    std::uint64_t version = 0;
  };
  std::map<Key, Entry> entries_;
};

}  // namespace kintsugi::viewer
