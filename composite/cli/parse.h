// Numbers, ranges, colours and sizes as they are written on the command line. All throw UsageError that names the flag.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {

// `count` finite numbers.
//   form  what is expected, for the message
std::vector<double> parseNumbers(const std::string& text, char separator, std::size_t count, const std::string& flag,
                                 const std::string& form);
std::size_t parseBytes(const std::string& text, const std::string& flag);                // "64M", "2G", "1048576"
bool isColour(const std::string& text);                                                  // rather than a file
glm::vec3 parseColour(const std::string& text, const std::string& flag);                 // "R,G,B"
std::pair<double, double> parseRange(const std::string& text, const std::string& flag);  // "NEAR:FAR"

}  // namespace pellucid::cli
