#pragma once
// Objects of the library as text for a person.

#include <string>

#include "segmenter/objects/library/known_object.hpp"
#include "segmenter/objects/library/object_library.hpp"

namespace kintsugi::segmenter {

/// "0.12 x 0.10 x 0.14 m": the sides of the model's box along the axes of O.
std::string size_text(const ObjectModel& model);

/// One line: what was learned.
std::string summary_text(const KnownObject& object);

/// A line for each object, below a line of titles.
std::string table_text(const ObjectLibrary& library);

/// Everything but points and views, a line each.
std::string details_text(const KnownObject& object);

/// Warns of each object that is not used.
void warn_of_refusals(const ObjectLibrary& library);

/// The object of that name.
/// @throws std::runtime_error naming the library, why the object was refused, or those there are
const KnownObject& require_object(const ObjectLibrary& library, const std::string& name);

}  // namespace kintsugi::segmenter
