// Damage to headers: names of attributes and channels, values and types, and bytes.
#pragma once
#include <string>

#include "tests/gbuffer/exr_files.h"
#include "tests/support/random.h"

namespace pellucid::test {

// One to three wounds to a file's parts, before it is written.
void wound(std::vector<Part>& parts, Random& random);

// The same to the bytes before the pixels.
//   header  how many these are
void woundBytes(std::string& file, std::size_t header, Random& random);

// One to three to a text.
std::string woundedText(std::string text, Random& random);

}  // namespace pellucid::test
