// Text of files whose exporter wrote the bytes of its machine's code page where UTF-8 is due.
#pragma once
#include <optional>
#include <string>

#include "engine_bridge/scene/mapped_file.h"

namespace pellucid::gltf {

// The same with each byte that is not of UTF-8 read as a character of Latin-1; empty where all of it is UTF-8.
std::optional<std::string> fromLatin1(Bytes text);

}  // namespace pellucid::gltf
