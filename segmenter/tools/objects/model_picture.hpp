#pragma once

#include <filesystem>

#include "segmenter/objects/model/object_model.hpp"

namespace kintsugi::segmenter {

/// Draws the model from three sides (against y, against x, from above) at one scale, with a bar for
/// it, and writes a PNG file.
/// @throws std::system_error naming the file and the reason
void write_model_picture(const ObjectModel& model, const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
