// campaign_order [COUNT [SAMPLE...]]: every sample and two hundred random stacks at 160 x 90, drawn COUNT times in
// shuffled orders with three chunk sizes, three tile sizes, and one and two threads. Prints what changed in each tier
// and how far its sums are from long double ones; ends with 1 when the exact tier changed a bit or is off by more than
// 1e-6.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "engine_bridge/scene/gltf.h"
#include "gbuffer/opaque_io.h"
#include "tests/campaign/order_trial.h"
#include "tests/campaign/stacks.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 160, kHeight = 90, kParts = 2;  // a part has as many threads as its number
constexpr double kExactError = 1e-6;
constexpr const char* kStacks = "stacks";

// Memory that forked parts share.
template <class T>
T* sharedArray(std::size_t count) {
  void* memory = mmap(nullptr, count * sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory to share between the parts of a trial");
  return static_cast<T*>(memory);
}

OrderShot load(const std::string& folder, const std::string& name) {
  OrderShot shot;
  if (name == kStacks) {
    Stage stage = stacksScene(41);
    shot.scene = std::move(stage.scene);
    shot.gbuffer = std::move(stage.gbuffer);
    shot.camera = stage.camera;
    shot.settings.weight = {shading::PLD_WEIGHT_POWER, 0.1f, 1000.0f, 3.0f, 1.0f};
  } else {
    shot.gbuffer = readOpaque(folder + "/" + name + ".exr", {}).gbuffer;
    shot.scene = loadScene({folder + "/" + name + ".glb"}, {});
    if (!shot.gbuffer.camera) throw std::runtime_error(name + ": no camera");
    shot.camera = *shot.gbuffer.camera;
  }
  shot.settings.surroundings = glm::vec3(0.3f, 0.35f, 0.4f);
  return shot;
}

constexpr std::size_t kTierCount = std::size(kTiers);

struct Board {  // shared
  OrderResult results[kTierCount][kParts];
  bool done[kParts];
  std::uint8_t planes[kTierCount][planeValues(kWidth * kHeight)];
  std::uint8_t picture[kTierCount][kWidth * kHeight * 4];
};

void playPart(int part, const std::string& folder, const std::string& name, std::uint64_t count, Board& board) {
  const auto threads = static_cast<std::size_t>(part) + 1;
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);  // llvmpipe's
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  const OrderShot shot = load(folder, name);
  GlContext context;
  TransparentPass pass(context, shot.scene, shot.gbuffer, shot.camera);
  for (std::size_t t = 0; t < kTierCount; ++t) {
    const Marks marks{board.planes[t], board.picture[t]};
    const TurnRange turns{static_cast<std::uint64_t>(part) + 1, count, kParts};
    board.results[t][part] = runOrderTrial(pass, shot, kTiers[t], turns, marks);
  }
  board.done[part] = true;
}

// GL drivers and thread pools do not survive a fork, so the parent never starts either.
void playParts(const std::string& folder, const std::string& name, std::uint64_t count, Board& board) {
  pid_t children[kParts];
  for (int part = 0; part < kParts; ++part) {
    std::fflush(stdout);
    children[part] = fork();
    if (children[part] != 0) continue;
    int code = 0;
    try {
      playPart(part, folder, name, count, board);
    } catch (const std::exception& error) {
      fmt::print(stderr, "campaign_order: {}: {}\n", name, error.what());
      code = 1;
    }
    std::fflush(nullptr);
    _exit(code);
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  for (const bool done : board.done)
    if (!done) throw std::runtime_error(name + ": a part of the trial did not end");
}

bool report(const std::string& name, const Board& board) {
  bool holds = true;
  for (std::size_t t = 0; t < kTierCount; ++t) {
    const OrderResult &one = board.results[t][0], &two = board.results[t][1];
    const auto changedPlanes = std::count(board.planes[t], board.planes[t] + one.values, std::uint8_t{1});
    const auto changedPicture = std::count(board.picture[t], board.picture[t] + one.pictureValues, std::uint8_t{1});
    const double error = std::max(one.worstError, two.worstError);
    fmt::print("{:<10} {:<9} {:>5} {:>4}-{:<4} {:>5} {:>9} {:>8} {:>9.2g} {:>9.2g} {:>8} {:>9.2g} {}\n", name,
               nameOf(kTiers[t]), one.turns + two.turns, std::min(one.leastChunks, two.leastChunks),
               std::max(one.mostChunks, two.mostChunks), std::max(one.mostTiles, two.mostTiles), one.values,
               changedPlanes, error, std::max(one.error99, two.error99), changedPicture,
               std::max(one.worstPictureChange, two.worstPictureChange), one.digest == two.digest ? "same" : "differ");
    if (kTiers[t] == Tier::exact)
      holds =
          holds && changedPlanes == 0 && error <= kExactError && one.digest == two.digest && one.values == two.values;
  }
  std::fflush(stdout);
  return holds;
}

int run(const std::vector<std::string>& arguments) {
  std::uint64_t count = 1000;
  if (!arguments.empty()) {
    const std::string& text = arguments[0];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size() || count < kParts) {
      fmt::print(stderr, "campaign_order: COUNT: found '{}', expected a whole number from {}\n", text, kParts);
      return 2;
    }
  }
  const std::string folder = freshFolder("campaign-order-" + std::to_string(getpid()));
  RunOptions generator;
  generator.program = "pellucid_samples";
  const Ended made = runProgram({folder, "all", std::to_string(kHeight)}, generator);
  if (made.code != 0) throw std::runtime_error("pellucid_samples: " + made.err);
  std::vector<std::string> names;
  for (const std::string& file : filesIn(folder))
    if (file.size() > 4 && file.substr(file.size() - 4) == ".glb") names.push_back(file.substr(0, file.size() - 4));
  names.emplace_back(kStacks);
  if (arguments.size() > 1)
    names.erase(std::remove_if(names.begin(), names.end(),
                               [&](const std::string& name) {
                                 return std::find(arguments.begin() + 1, arguments.end(), name) == arguments.end();
                               }),
                names.end());
  if (names.empty()) {
    fmt::print(stderr, "campaign_order: no such sample\n");
    return 2;
  }
  fmt::print("{:<10} {:<9} {:>5} {:>9} {:>5} {:>9} {:>8} {:>9} {:>9} {:>8} {:>9} {}\n", "scene", "tier", "turns",
             "chunks", "tiles", "values", "changed", "error", "error99", "picture", "by", "threads");
  auto* board = sharedArray<Board>(1);
  bool holds = true;
  for (const std::string& name : names) {
    std::memset(static_cast<void*>(board), 0, sizeof(Board));
    playParts(folder, name, count, *board);
    holds = report(name, *board) && holds;
  }
  std::filesystem::remove_all(folder);
  fmt::print("exact: {}\n", holds ? "no bit changed, every sum within 1e-6 of the long double one" : "FAILED");
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace pellucid::test

int main(int count, char** arguments) {
  try {
    return pellucid::test::run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "campaign_order: {}\n", error.what());
    return 1;
  }
}
