// What a finished frame is known by: its inputs and the flags that make it what it is.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/cli/verb_paths.h"
#include "composite/sequence/digest.h"

namespace pellucid::cli {

// Of the program's version, the verb, its flags as they stand and the bytes of the files that they name, those among
// them that a glTF names, and $OCIO. Flags that change no bit (threads, budget, jobs) and names of outputs are left
// out, and so is where files lie. Throws InputError for a file that cannot be read.
//   weight  that was fitted to another frame, as text; "" for none
std::string frameDigest(const CLI::App& verb, const std::vector<VerbPath>& paths, const std::string& weight,
                        FileDigests& files);

// Whether all outputs are there, and the picture says this digest of itself.
bool isFinished(const std::vector<VerbPath>& paths, const std::string& digest);

}  // namespace pellucid::cli
