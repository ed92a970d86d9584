#pragma once
// What a power cut must not take: file contents, and the entries of folders, which are on the disk
// only when the folder itself is synced.

#include <filesystem>
#include <string>

namespace kintsugi {

/// Waits until what was written to the open file is on the disk. Does nothing where the file system
/// cannot sync such a file.
/// @param name of the file in errors, with quotes
/// @throws std::system_error; what was written since the last success may be lost then, also when a
///   later call succeeds: it has to be written again
void sync_file(int descriptor, const std::string& name);

/// Waits until the entries of the folder (created, renamed and removed files) are on the disk.
/// Empty: the current folder. @throws std::system_error as sync_file()
void sync_folder(const std::filesystem::path& folder);

/// Makes the folder, with those above it, so that a power cut does not take what will be in it.
/// Does nothing where it exists. @throws std::system_error naming the folder
void make_folder(const std::filesystem::path& folder);

}  // namespace kintsugi
