// pellucid_samples OUTDIR [NAME|all [HEIGHT]] [--hairs N | --particles N]: writes OUTDIR/NAME.exr and OUTDIR/NAME.glb,
// HEIGHT pixels high.
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

// How many hairs or particles, where it is asked for; 0 leaves a sample as it is.
struct Counts {
  std::uint32_t hairs = 0, particles = 0;
};

Sample made(const Entry& entry, Counts counts) {
  if (counts.hairs && entry.make == hair) return fineHair(counts.hairs);
  if (counts.particles && entry.make == smokeball) return smokeBall(counts.particles);
  return entry.make();
}

void write(const Entry& entry, const std::string& folder, int height, Counts counts) {
  const Sample sample = made(entry, counts);
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

int numberOf(const char* text, const std::string& what, int most) {
  int number = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), number);
  if (error != std::errc() || *end != '\0' || number < 1 || number > most)
    throw UsageError(what + " " + text + ": expected 1 to " + std::to_string(most));
  return number;
}

void run(int count, char** arguments) {
  constexpr int kTallest = 4320, kMostHairs = 150000;  // more do not fit into one GLB
  constexpr int kMostParticles = 100000000;
  Counts counts;
  if (count > 3 && std::string(arguments[count - 2]) == "--hairs") {
    counts.hairs = static_cast<std::uint32_t>(numberOf(arguments[count - 1], "--hairs", kMostHairs));
    count -= 2;
  } else if (count > 3 && std::string(arguments[count - 2]) == "--particles") {
    counts.particles = static_cast<std::uint32_t>(numberOf(arguments[count - 1], "--particles", kMostParticles));
    count -= 2;
  }
  if (count < 2 || count > 4 || arguments[1][0] == '-')
    throw UsageError("expected OUTDIR [NAME|all [HEIGHT]] [--hairs N | --particles N], NAME one of " + names());
  const std::string folder = arguments[1], wanted = count > 2 ? arguments[2] : "all";
  const int height = count > 3 ? numberOf(arguments[3], "HEIGHT", kTallest) : 0;
  bool known = wanted == "all";
  for (const Entry& entry : kSamples) known = known || wanted == entry.name;
  if (!known) throw UsageError("no sample named '" + wanted + "'; expected one of " + names() + ", or all");
  if (counts.hairs && wanted != "hair" && wanted != "all")
    throw UsageError("--hairs: the sample " + wanted + " has none");
  if (counts.particles && wanted != "smokeball" && wanted != "all")
    throw UsageError("--particles: the sample " + wanted + " has none");
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw ResourceError(folder + ": no such folder could be made: " + failure.message());
  for (const Entry& entry : kSamples)
    if (wanted == "all" || wanted == entry.name) write(entry, folder, height, counts);
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
