#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant {

/// What a glTF 2.0 file is made of, before anybody looks at what it means.
struct GltfContainer {
  nlohmann::json root;               ///< an object
  std::vector<std::uint8_t> binary;  ///< of a binary file; empty where there is none
};

/// Takes a file apart: a binary one (.glb) or JSON (.gltf), whichever the bytes are. `path` is for messages.
/// Throws DataError naming it.
GltfContainer open_gltf(const std::vector<std::uint8_t>& bytes, const std::string& path);

/// The bytes that the `uri` of a buffer stands for: data within it, or a file named relative to that of the
/// glTF at `path`. Throws DataError naming `path` and what is wrong.
std::vector<std::uint8_t> resolve_uri(const std::string& uri, const std::string& path);

/// A value of the file for a message: on one line, whatever is in it, and not too long.
std::string shown_json(const nlohmann::json& value);

}  // namespace pliant
