#pragma once
// One object of a library on disk: the folder NAME with object.json and model.ply.

#include <filesystem>
#include <string>
#include <string_view>

#include "segmenter/objects/library/known_object.hpp"

namespace kintsugi::segmenter {

inline constexpr const char* kObjectFile = "object.json";
inline constexpr const char* kModelFile = "model.ply";

/// Reads the object whose folder this is. Sizes are held against bounds and against the size of the
/// files before memory is taken for them.
/// @throws std::runtime_error naming the file, the place, the reason and what was expected: a file
///   that is missing, damaged, of another program or of a newer version; a name that is not the
///   folder's; what check_object() throws for
KnownObject read_object(const std::filesystem::path& folder);

/// The same of the contents of both files; `folder` stands for them in errors.
KnownObject parse_object(std::string_view json, std::string_view model,
                         const std::filesystem::path& folder);

/// Writes the object into `library`, which is made when it is absent, in place of an older one with
/// that name: whatever happens, there is the whole older one or the whole new one. Two programs
/// that write into one library take turns with a LibraryLock.
/// @throws std::runtime_error (std::system_error is one) naming the file and the reason; then the
///   older one is still there
void write_object(const KnownObject& object, const std::filesystem::path& library);

/// Where the file system cannot exchange two names: puts objects back of which the replacement was
/// interrupted. Nobody may write meanwhile.
/// @throws std::system_error naming what cannot be read, renamed or removed
void bring_back_objects(const std::filesystem::path& library);

/// Removes an object, whole or damaged.
/// @throws std::runtime_error naming the folder when there is none of that name, or it cannot be
///   removed
void remove_object(const std::string& name, const std::filesystem::path& library);

}  // namespace kintsugi::segmenter
