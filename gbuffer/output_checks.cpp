#include "gbuffer/output_checks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "gbuffer/errors.h"
#include "gbuffer/writable.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

// ".exr" of "Shot.EXR", "" where the name has none.
std::string extensionOf(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void expectName(const Output& output) {
  const std::string extension = extensionOf(output.path);
  if (output.kind == OutputKind::exr && extension != ".exr")
    throw UsageError(fmt::format("{}: found '{}', expected a name that ends in .exr: an OpenEXR file is written",
                                 output.flag, output.path));
  if (output.kind == OutputKind::page && extension != ".html" && extension != ".htm")
    throw UsageError(
        fmt::format("{}: found '{}', expected a name that ends in .html: a page is written", output.flag, output.path));
  if (output.kind == OutputKind::image && extension != ".png")
    throw UsageError(
        fmt::format("{}: found '{}', expected a name that ends in .png: a PNG is written", output.flag, output.path));
  if (output.kind != OutputKind::folder) return;
  if (output.path.empty())
    throw UsageError(fmt::format("{}: found an empty name, expected that of a folder", output.flag));
  for (const char* file : {".exr", ".png", ".svg", ".html", ".htm", ".csv", ".json", ".txt"})
    if (extension == file)
      throw UsageError(fmt::format("{}: found '{}', expected the name of a folder: several files are written",
                                   output.flag, output.path));
}

// The folder itself or, where it does not exist yet, the nearest one above it that does.
void expectFolder(const std::string& path) {
  std::error_code unused;
  fs::path existing = fs::absolute(path, unused).lexically_normal();
  while (!fs::exists(existing, unused) && existing.has_parent_path() && existing != existing.parent_path())
    existing = existing.parent_path();
  if (!fs::is_directory(existing, unused))
    throw ResourceError(
        fmt::format("{}: cannot be made: found a file at {}, expected a folder", path, existing.string()));
  if (::access(existing.c_str(), W_OK | X_OK) != 0)
    throw ResourceError(
        fmt::format("{}: cannot be written in folder {}: {}", path, existing.string(), std::strerror(errno)));
}

// One file under two names, links included; of files that are not there yet the names themselves.
bool same(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  std::error_code first, second;
  const fs::path left = fs::weakly_canonical(a, first), right = fs::weakly_canonical(b, second);
  return !first && !second && left == right;
}

}  // namespace

void checkOutputs(const std::vector<Output>& outputs, const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Output& output = outputs[i];
    expectName(output);
    for (const std::string& input : inputs)
      if (same(output.path, input))
        throw UsageError(fmt::format("{}: found '{}', which is also an input, expected another name: it would be lost",
                                     output.flag, output.path));
    for (std::size_t k = 0; k < i; ++k)
      if (same(output.path, outputs[k].path))
        throw UsageError(fmt::format("{}: found '{}', which {} writes too, expected another name", output.flag,
                                     output.path, outputs[k].flag));
  }
  for (const Output& output : outputs)
    if (output.kind == OutputKind::folder)
      expectFolder(output.path);
    else
      expectWritable(output.path);
}

}  // namespace pellucid
