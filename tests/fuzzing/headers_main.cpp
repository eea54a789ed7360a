// fuzz_headers [COUNT [SEED]]: COUNT damaged headers and configs. Three in four are files as renderers write them, with
// names of channels and attributes, values, types and bytes of their headers changed; the others are OpenColorIO
// configs. A finding is a crash, an exception that is no sentence of ours, and a silent default: depth, camera, space
// or pixel aspect that are not what the whole file means, without a word. Findings are kept; ends with 1 when there are
// some.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "tests/fuzzing/config_wounds.h"
#include "tests/fuzzing/fuzz_program.h"
#include "tests/fuzzing/header_wounds.h"
#include "tests/gbuffer/layouts.h"

namespace pellucid::test {
namespace {

constexpr std::uint64_t kChunk = 250;  // trials of a child process

// Where the header of a file of one part ends; 0 of several parts.
std::size_t headerEnd(const std::string& file) {
  std::size_t at = 8;
  while (at < file.size() && file[at] != '\0') {
    at = file.find('\0', file.find('\0', at) + 1) + 1;  // its name, its type
    std::uint32_t size = 0;
    std::memcpy(&size, file.data() + at, 4);
    at += 4 + size;
  }
  return (static_cast<unsigned char>(file[5]) & 0x10) != 0 ? 0 : at;
}

bool says(const std::vector<std::string>& notes, std::initializer_list<const char*> words) {
  for (const std::string& note : notes)
    for (const char* word : words)
      if (note.find(word) != std::string::npos) return true;
  return false;
}

std::string wrongDepth(const OpaqueFile& file, const Layout& layout, const Room& room) {
  const Window whole{0, 0, Room::kWidth, Room::kHeight};
  if (file.gbuffer.display != whole || file.gbuffer.data != whole) return "";
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < room.z.size(); ++i)
    wrong += !(std::abs(static_cast<double>(file.gbuffer.viewZ[i]) / room.z[i] - 1) <= layout.slack);
  if (wrong == 0 || says(file.notes, {"--depth-kind", "--unit", "compression has changed"})) return "";
  return fmt::format("{} pixels of depth wrong as {} {}", wrong, file.choice.depthChannel, file.choice.depthKind);
}

std::string wrongWords(const OpaqueFile& file) {
  const ExrPart& part = file.document.parts[static_cast<std::size_t>(file.choice.beautyPart)];
  const bool stated = part.attributes.contains("worldToCamera") || part.attributes.contains("worldToNDC");
  if (stated && !file.gbuffer.camera && !says(file.notes, {"worldToCamera", "worldToNDC"})) return "no camera";
  if (part.attributes.contains("chromaticities") && file.space.source != SpaceSource::chromaticities &&
      !says(file.notes, {"chromaticities"}))
    return "no colour space";
  const double aspect = file.gbuffer.pixelAspect;
  if (!(aspect > 0.0 && std::isfinite(aspect))) return fmt::format("a pixel aspect of {}", aspect);
  if (const auto filter = part.text("pellucid:filter");
      filter && !file.choice.pixelFilter && !says(file.notes, {"pellucid:filter"}))
    return "no filter";
  return "";
}

// As composite reads it, with a glTF's camera where the file has none. "" where all is well, else what is not.
std::string readHeader(const std::string& path, const Layout& layout, const Room& room, bool& refused) {
  try {
    ReadOptions framing;
    framing.framingAlone = true;
    const OpaqueFile first = readOpaque(path, framing);
    const Camera camera = first.gbuffer.camera.value_or(room.camera);
    const OpaqueFile file = readOpaque(path, {}, &camera);
    const std::string wrong = wrongDepth(file, layout, room);
    return wrong.empty() ? wrongWords(file) : wrong;
  } catch (const Error& error) {
    refused = true;
    const bool code = error.exitCode() == 3 || error.exitCode() == 4;
    return code && std::string(error.what()).size() > 20 ? "" : fmt::format("says '{}'", error.what());
  } catch (const std::exception& error) {
    return fmt::format("throws '{}'", error.what());
  }
}

struct Trial {
  std::string finding;
  bool refused = false;
};

Trial headerTrial(std::uint64_t number, const std::vector<Layout>& layouts, const Room& room, const std::string& file) {
  Random random(number);
  const Layout& layout = layouts[random.below(static_cast<std::uint32_t>(layouts.size()))];
  for (;;) try {
      std::vector<Part> parts = layout.parts;
      const bool bytes = random.below(3) == 0;
      if (!bytes) wound(parts, random);
      writeFile(file, parts);
      if (bytes) {
        std::string whole = slurp(file);
        if (const std::size_t header = headerEnd(whole)) woundBytes(whole, header, random);
        spit(file, whole);
      }
      break;
    } catch (const std::exception&) {
      continue;  // a header that OpenEXR does not write
    }
  Trial trial;
  trial.finding = readHeader(file, layout, room, trial.refused);
  if (!trial.finding.empty())
    trial.finding = fmt::format("{} {} {}: {}", layout.producer, layout.depth, layout.words, trial.finding);
  return trial;
}

// What a chunk came to, as a line of text: through a pipe, for it may crash.
std::string chunk(std::uint64_t first, std::uint64_t last, std::uint64_t seed, const std::string& folder) {
  const Room room;
  std::vector<Layout> layouts = layoutsOf(room);
  std::erase_if(layouts, [](const Layout& layout) { return layout.decided.empty(); });
  std::string findings;
  std::uint64_t refused = 0;
  for (std::uint64_t i = first; i < last; ++i) {
    const bool config = i % 4 == 3;
    const std::string file = folder + (config ? "/damaged.ocio" : "/damaged.exr");
    const std::uint64_t number = seed * 1000003 + i;
    spit(folder + "/at", fmt::format("{}", i));
    Trial trial;
    if (config)
      trial.finding = configTrial(number, file, trial.refused);
    else
      trial = headerTrial(number, layouts, room, file);
    refused += trial.refused;
    if (trial.finding.empty()) continue;
    const std::string kept = fmt::format("{}/{}{}", folder, i, config ? ".ocio" : ".exr");
    spit(kept, slurp(file));
    findings += fmt::format("{}: {}\n", kept, trial.finding);
  }
  return fmt::format("{} {}\n{}", refused, std::count(findings.begin(), findings.end(), '\n'), findings);
}

std::string inChild(std::uint64_t first, std::uint64_t last, std::uint64_t seed, const std::string& folder) {
  const std::string answer = folder + "/answer";
  spit(answer, "");
  const pid_t child = fork();
  if (child == 0) {
    alarm(300);
    spit(answer, chunk(first, last, seed, folder));
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return slurp(answer);
  return fmt::format("0 1\ntrial {}: {} {}\n", slurp(folder + "/at"), WIFSIGNALED(status) ? "signal" : "exit code",
                     WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
}

int run(int count, char** arguments) {
  const std::uint64_t wanted = count > 1 ? numberOf(arguments[1], "COUNT") : 20000;
  const std::uint64_t seed = count > 2 ? numberOf(arguments[2], "SEED") : 1;
  const std::string folder = freshFolder("fuzz-headers");
  writeConfigTables(folder);
  std::uint64_t refused = 0, findings = 0;
  for (std::uint64_t first = 0; first < wanted; first += kChunk) {
    const std::string told = inChild(first, std::min(first + kChunk, wanted), seed, folder);
    std::istringstream in(told);
    std::uint64_t some = 0, found = 0;
    in >> some >> found;
    refused += some;
    findings += found;
    if (found) fmt::print("{}", told.substr(told.find('\n') + 1));
    std::fflush(stdout);
  }
  fmt::print(
      "{} damaged headers and configs: {} refused with a sentence, {} read as they mean or with a word, {} "
      "findings\n",
      wanted, refused, wanted - refused - findings, findings);
  return findings == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pellucid::test

int main(int count, char** arguments) {
  return pellucid::test::endOf("fuzz_headers", pellucid::test::run, count, arguments);
}
