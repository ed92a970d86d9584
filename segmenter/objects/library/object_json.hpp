#pragma once
// The readable part of an object on disk: object.json.

#include <cstdint>
#include <string>
#include <string_view>

#include "segmenter/objects/library/known_object.hpp"

namespace kintsugi::segmenter {

/// Raised when older programs could not read the files of an object any more.
inline constexpr int kObjectVersion = 1;

/// object.json, and what it says of the points, which are in a file of their own.
struct ObjectDocument {
  KnownObject object;             ///< without points
  std::uint64_t num_points = 0;   ///< of model.ply
  std::uint32_t model_crc32 = 0;  ///< of all bytes of model.ply
};

/// The size of the object's box and its mean colour are in the text for people, and nobody reads
/// them back.
/// @param model_crc32 of model.ply, which has the points of `object`
std::string object_json(const KnownObject& object, std::uint32_t model_crc32);

/// @throws std::runtime_error naming the place (line and column, or the key), what was found and
///   what was expected: text that is no JSON, another format, a newer version, a key that is
///   missing or has another type, a number out of its bounds
ObjectDocument parse_object_json(std::string_view text);

}  // namespace kintsugi::segmenter
