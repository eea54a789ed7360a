// Damaged OpenColorIO configs, read as the program reads them.
#pragma once
#include <cstdint>
#include <string>

namespace pellucid::test {

// The files that the config names.
void writeConfigTables(const std::string& folder);

// Damages a config, writes it as `file` and reads it. "" where all is well, else what is not: an exception that is no
// sentence of ours, or a space that is not what OpenColorIO makes of the same file.
//   refused  is set where a sentence refuses it
std::string configTrial(std::uint64_t number, const std::string& file, bool& refused);

}  // namespace pellucid::test
