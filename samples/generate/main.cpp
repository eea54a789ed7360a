// pellucid_samples OUTDIR [NAME]: writes OUTDIR/NAME.exr and OUTDIR/NAME.glb, for every sample when none is named.
#include <cstdio>
#include <filesystem>
#include <string>

#include "gbuffer/errors.h"
#include "samples/generate/files.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

void write(const Entry& entry, const std::string& folder) {
  const Sample sample = entry.make();
  const std::string stem = folder + "/" + entry.name;
  writeOpaque(stem + ".exr", render(sample.studio, sample.view), sample.view);
  writeBytes(stem + ".glb", sample.glb.bytes());
  std::printf("%s.exr\n%s.glb\n", stem.c_str(), stem.c_str());
}

std::string names() {
  std::string out;
  for (const Entry& entry : kSamples) out += std::string(out.empty() ? "" : ", ") + entry.name;
  return out;
}

void run(int count, char** arguments) {
  if (count < 2 || count > 3)
    throw UsageError("pellucid_samples OUTDIR [NAME]: expected one of " + names() + ", or none for all");
  const std::string folder = arguments[1], wanted = count == 3 ? arguments[2] : "";
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw ResourceError(folder + ": no such folder could be made: " + failure.message());
  bool found = false;
  for (const Entry& entry : kSamples)
    if (wanted.empty() || wanted == entry.name) write(entry, folder), found = true;
  if (!found) throw UsageError("no sample named '" + wanted + "'; expected one of " + names());
}

}  // namespace
}  // namespace pellucid::samples

int main(int count, char** arguments) {
  try {
    pellucid::samples::run(count, arguments);
    return 0;
  } catch (const pellucid::Error& error) {
    std::fprintf(stderr, "pellucid_samples: %s\n", error.what());
    return error.exitCode();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pellucid_samples: %s\n", error.what());
    return 6;
  }
}
