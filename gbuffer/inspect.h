// What a file holds and how Pellucid understands it.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gbuffer/opaque_io.h"

namespace pellucid {

// Parts, windows, compressions, channels with type; the beauty and depth chosen, kind, far value, histogram of depth;
// camera; warnings; or why it cannot be used as a G-buffer ("refusal"). Throws InputError only when it cannot be read.
nlohmann::json inspectExr(const std::string& path, const ReadOptions& options);
// The same, for people.
std::string inspectionText(const nlohmann::json& report);

}  // namespace pellucid
