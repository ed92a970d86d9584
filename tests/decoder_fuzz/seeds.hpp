#pragma once
// The seeds of the fuzzers: small valid inputs, made by our own writers and so always up to date.

#include <filesystem>
#include <map>
#include <string>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::fuzzing {

/// Inputs by name.
using Seeds = std::map<std::string, Bytes>;

/// Seeds that several targets use.
Seeds message_seeds();  ///< one LCM message of each type
Seeds signed_message_seeds();
Seeds log_seeds();  ///< logs of chunked messages and heartbeats
Seeds request_seeds();
Seeds stored_session_seeds();
Seeds rgbd_frame_seeds();
Seeds image_seeds();
Seeds cloud_file_seeds();
Seeds ply_seeds();
Seeds point_file_seeds();
Seeds saved_map_seeds();
Seeds object_seeds();
Seeds views_file_seeds();
Seeds oni_seeds();
Seeds recording_file_seeds();
Seeds text_seeds(const std::string& target);

}  // namespace kintsugi::fuzzing
