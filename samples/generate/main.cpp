// pellucid_samples OUTDIR [NAME|all [HEIGHT]]: writes OUTDIR/NAME.exr and OUTDIR/NAME.glb, HEIGHT pixels high.
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include "gbuffer/errors.h"
#include "samples/generate/files.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

// The same view with `height` rows; 0 keeps the sample's own.
View resized(View view, int height) {
  if (height == 0) return view;
  if (height * view.width % view.height != 0)
    throw UsageError("HEIGHT " + std::to_string(height) + ": expected one that keeps the shape of " +
                     std::to_string(view.width) + "x" + std::to_string(view.height) + ", such as 1080");
  view.width = height * view.width / view.height;
  view.height = height;
  return view;
}

void write(const Entry& entry, const std::string& folder, int height) {
  const Sample sample = entry.make();
  const View view = resized(sample.view, height);
  const std::string stem = folder + "/" + entry.name;
  writeOpaque(stem + ".exr", render(sample.studio, view), view);
  writeBytes(stem + ".glb", sample.glb.bytes());
  std::printf("%s.exr\n%s.glb\n", stem.c_str(), stem.c_str());
}

std::string names() {
  std::string out;
  for (const Entry& entry : kSamples) out += std::string(out.empty() ? "" : ", ") + entry.name;
  return out;
}

int heightOf(const char* text) {
  constexpr int kTallest = 4320;
  int height = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), height);
  if (error != std::errc() || *end != '\0' || height < 1 || height > kTallest)
    throw UsageError("HEIGHT " + std::string(text) + ": expected 1 to " + std::to_string(kTallest) + " pixels");
  return height;
}

void run(int count, char** arguments) {
  if (count < 2 || count > 4) throw UsageError("expected OUTDIR [NAME|all [HEIGHT]], NAME one of " + names());
  const std::string folder = arguments[1], wanted = count > 2 ? arguments[2] : "all";
  const int height = count > 3 ? heightOf(arguments[3]) : 0;
  bool known = wanted == "all";
  for (const Entry& entry : kSamples) known = known || wanted == entry.name;
  if (!known) throw UsageError("no sample named '" + wanted + "'; expected one of " + names() + ", or all");
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw ResourceError(folder + ": no such folder could be made: " + failure.message());
  for (const Entry& entry : kSamples)
    if (wanted == "all" || wanted == entry.name) write(entry, folder, height);
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
