// fuzz_files [COUNT [SEED]]: COUNT damaged copies of the files that the program reads, each given to the verb that
// reads it. A finding is a crash, a run without end, an exit code or a memory peak that the contract does not have, a
// failure without a sentence, or one that leaves output behind. Findings are kept; ends with 1 when there are some.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "tests/fuzzing/fuzz_program.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr std::size_t kMostBytes = std::size_t{3} << 30;  // GL, Embree and their libraries take .3 of them

constexpr double kMostCpu = 10;  // s; whole files take less than 1
constexpr rlim_t kEndCpu = 60;   // s, when a run without end is ended; ours is far below it

// A file, and the command that reads its damaged copy: "@" stands for it.
struct Subject {
  std::string file;
  std::vector<std::string> command;
};

std::string damaged(const std::string& whole, Random& random) {
  std::string bytes = whole;
  const auto place = [&](std::size_t size) {
    // Headers decide most: a third of the damage goes to the first two thousand bytes.
    const std::size_t reach = random.below(3) == 0 ? std::min<std::size_t>(size, 2048) : size;
    return static_cast<std::size_t>(random.bits() % std::max<std::size_t>(reach, 1));
  };
  const std::uint32_t wounds = 1 + random.below(3);
  for (std::uint32_t i = 0; i < wounds && !bytes.empty(); ++i) switch (random.below(12)) {
      case 0:  // a bit
        bytes[place(bytes.size())] ^= static_cast<char>(1u << random.below(8));
        break;
      case 1:  // a byte
        bytes[place(bytes.size())] = static_cast<char>(random.below(256));
        break;
      case 2:
      case 3:
      case 4: {  // a number at its limits
        constexpr std::uint32_t limits[] = {0u,          1u,          0x7fffffffu, 0x80000000u,
                                            0xffffffffu, 0x7f800000u, 0x7fc00000u, 65536u};
        const std::uint32_t value = limits[random.below(8)];
        const std::size_t at = place(bytes.size());
        for (std::size_t k = 0; k < 4 && at + k < bytes.size(); ++k)
          bytes[at + k] = static_cast<char>(value >> (8 * k));
        break;
      }
      case 5:  // the end is missing
        bytes.resize(bytes.size() - std::min(bytes.size() - 1, place(bytes.size())));
        break;
      case 6: {  // a piece of it twice
        const std::size_t from = place(bytes.size()),
                          length = std::min<std::size_t>(1 + random.below(64), bytes.size() - from);
        bytes.insert(place(bytes.size()), bytes.substr(from, length));
        break;
      }
      case 7: {  // a piece is missing
        const std::size_t from = place(bytes.size());
        bytes.erase(from, std::min<std::size_t>(1 + random.below(64), bytes.size() - from));
        break;
      }
      default: {  // a digit is another, as in the JSON of a scene
        const std::size_t from = place(bytes.size()), at = bytes.find_first_of("0123456789", from);
        if (at != std::string::npos) bytes[at] = "0123456789-eE. \""[random.below(16)];
      }
    }
  return bytes;
}

void require(const std::vector<std::string>& arguments, const std::string& program = "pellucid") {
  RunOptions options;
  options.program = program;
  const Ended ended = runProgram(arguments, options);
  if (ended.code != 0) throw std::runtime_error(ended.err);
}

std::vector<Subject> makeSubjects(const std::string& folder) {
  for (const char* sample : {"bottles", "foliage"}) require({folder, sample, "72"}, "pellucid_samples");
  const std::string picture = folder + "/bottles.exr", glass = folder + "/bottles.glb",
                    leaves = folder + "/foliage.glb";
  require({"accumulate", picture, glass, "-o", folder + "/planes.exr"});
  require({"fragments", picture, glass, "-o", folder + "/deep.exr"});
  require({"fragments", folder + "/foliage.exr", leaves, "-o", folder + "/deep2.exr"});
  return {{picture, {"inspect", "@"}},
          {picture, {"composite", "@", glass, "-o", "OUT", "--aa", "1"}},
          {glass, {"composite", picture, "@", "-o", "OUT", "--aa", "1"}},
          {leaves, {"gbuffer", "@", "-o", "OUT", "--size", "32x18", "--samples", "1", "--renderer", "gl"}},
          {leaves, {"composite", folder + "/foliage.exr", "@", "-o", "OUT", "--aa", "1"}},
          {folder + "/planes.exr", {"resolve", picture, "@", "-o", "OUT"}},
          {folder + "/deep.exr", {"flatten", "@", "-o", "OUT"}},
          {folder + "/deep2.exr", {"composite", folder + "/foliage.exr", "@", "-o", "OUT", "--aa", "1"}},
          {picture, {"composite", picture, glass, "-o", "OUT", "--aa", "1", "--environment", "@"}},
          {picture, {"compare", picture, "@"}}};
}

// What is wrong with the end of a run; "" for nothing.
std::string wrongWith(const Ended& ended, bool compares, bool wrote) {
  if (ended.code >= 128) return fmt::format("killed by signal {}", ended.code - 128);
  const bool known = ended.code == 0 || ended.code == 2 || ended.code == 3 || ended.code == 4 || ended.code == 6 ||
                     (compares && ended.code == 1);
  if (!known) return fmt::format("exit code {}", ended.code);
  if (ended.code != 0 && ended.err.find("pellucid: ") == std::string::npos) return "failed without a sentence";
  if (ended.code != 0 && wrote) return "failed, and left output";
  if (ended.cpuSeconds > kMostCpu) return fmt::format("took {:.0f} s of CPU", ended.cpuSeconds);
  if (ended.peakBytes > kMostBytes) return fmt::format("took {} MiB", ended.peakBytes >> 20);
  return "";
}

int run(int count, char** arguments) {
  const std::uint64_t wanted = count > 1 ? numberOf(arguments[1], "COUNT") : 1000;
  const std::uint64_t seed = count > 2 ? numberOf(arguments[2], "SEED") : 1;
  const std::string folder = freshFolder("fuzz"), findings = freshFolder("fuzz-findings"),
                    work = freshFolder("fuzz-work");
  const rlimit cpu{kEndCpu, kEndCpu};
  setrlimit(RLIMIT_CPU, &cpu);
  const std::vector<Subject> subjects = makeSubjects(folder);
  std::map<int, std::uint64_t> codes;
  std::uint64_t found = 0;
  double slowest = 0;
  for (std::uint64_t i = 0; i < wanted; ++i) {
    Random random(seed * 1000003 + i);
    const Subject& subject = subjects[i % subjects.size()];
    const std::string ending = subject.file.substr(subject.file.rfind('.'));
    const std::string copy = folder + "/damaged" + ending, out = work + "/out.exr";
    for (const std::string& file : filesIn(work)) std::filesystem::remove(work + "/" + file);
    std::ofstream(copy, std::ios::binary) << damaged(slurp(subject.file), random);
    std::vector<std::string> command = subject.command;
    for (std::string& word : command) word = word == "@" ? copy : word == "OUT" ? out : word;
    const Ended ended = runProgram(command);
    ++codes[ended.code];
    slowest = std::max(slowest, ended.seconds);
    const std::string wrong = wrongWith(ended, command[0] == "compare", !filesIn(work).empty());
    if (wrong.empty()) continue;
    ++found;
    const std::string kept = fmt::format("{}/{}{}", findings, i, ending);
    std::filesystem::copy_file(copy, kept, std::filesystem::copy_options::overwrite_existing);
    fmt::print("{}: {}: {} {}\n", kept, wrong, command[0], ended.err.substr(0, 200));
    std::fflush(stdout);
  }
  fmt::print("{} damaged files, {} findings; slowest {:.1f} s; exit codes", wanted, found, slowest);
  for (const auto& [code, times] : codes) fmt::print(" {}: {}", code, times);
  fmt::print("\n");
  return found == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pellucid::test

int main(int count, char** arguments) {
  return pellucid::test::endOf("fuzz_files", pellucid::test::run, count, arguments);
}
