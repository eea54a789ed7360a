// URIs as glTF uses them: data: with base64, or a relative path with %XX escapes. Schemes are in any case.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::gltf {

// Standard or URL-safe alphabet, padding optional, white space anywhere. False when a character is foreign or the
// length impossible.
bool decodeBase64(std::string_view text, std::vector<std::uint8_t>& bytes);

// %XX to bytes; anything else, a stray % included, stays.
std::string decodePercent(std::string_view text);

bool isDataUri(std::string_view uri);
// Splits and decodes "data:[type][;base64],content", %XX in base64 included. False when it is malformed.
bool decodeDataUri(std::string_view uri, std::vector<std::uint8_t>& bytes);

// "http" of "http://host/a.png"; empty for a path.
std::string_view uriScheme(std::string_view uri);

}  // namespace pellucid::gltf
