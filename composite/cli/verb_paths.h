// Which values of a verb's flags are names of files: what it reads and what it writes.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/output_checks.h"

namespace pellucid::cli {

struct VerbPath {
  CLI::Option* option = nullptr;
  std::string flag;                   // "--output"; the name of a positional one
  std::optional<OutputKind> written;  // what is written there; nothing: it is read
  bool kept = true;                   // an output of the same name would lose it
};

// Those of the flags and positions that the verb has, in the verb's order, given or not.
std::vector<VerbPath> pathsOf(const CLI::App& verb);

// The file in a flag's value: "N=normals.exr" and "depth.exr:Z" hold more. Of a value that names none, such as a
// channel, a colour or a number, the value itself.
std::string fileNamedIn(const std::string& flag, const std::string& value);

}  // namespace pellucid::cli
