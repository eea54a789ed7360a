// Files in the address space: pages come and go, and a file that shrinks under us is an error, not a crash.
#include "engine_bridge/scene/mapped_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <numeric>

#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

constexpr std::size_t kSize = std::size_t{8} << 20;

std::filesystem::path bigFile() {
  const std::filesystem::path path = testFolder() / "big.bin";
  std::vector<std::uint8_t> bytes(kSize);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 4096);
  writeBytes(path, bytes.data(), bytes.size());
  return path;
}

std::uint64_t sum(Bytes bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
}

// Bytes of mapped files in memory, from the kernel.
std::size_t residentFileBytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "RssFile:") {
      std::size_t kilobytes = 0;
      status >> kilobytes;
      return kilobytes << 10;
    }
  return 0;
}

TEST(MappedFile, PagesLeaveAndComeBack) {
  const MappedFile file(bigFile().string(), "test");
  ASSERT_EQ(file.bytes().size(), kSize);
  const std::size_t before = residentFileBytes();
  const std::uint64_t first = sum(file.bytes());
  const std::size_t read = residentFileBytes();
  file.letGo(file.bytes().subspan(5000, kSize - 10000));
  const std::size_t after = residentFileBytes();
  std::printf("resident file pages: %zu KiB, read %zu KiB, let go %zu KiB\n", before >> 10, read >> 10, after >> 10);
  EXPECT_GE(read, before + kSize / 2);
  EXPECT_LE(after, before + kSize / 16);
  EXPECT_EQ(sum(file.bytes()), first);
  file.requireWhole();
}

TEST(MappedFile, OneThatShrinksIsAnError) {
  const std::filesystem::path path = bigFile();
  const MappedFile file(path.string(), "scene.glb"), other(path.string(), "other.glb");
  std::filesystem::resize_file(path, 10000);
  EXPECT_EQ(file.bytes()[5000], static_cast<std::uint8_t>(5000 * 7 + 1));
  file.requireWhole();  // nothing that is gone was read
  EXPECT_EQ(sum(file.bytes().subspan(3 << 20)), 0u);
  try {
    file.requireWhole();
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string text = error.what();
    std::printf("%s\n", text.c_str());
    EXPECT_NE(text.find("scene.glb"), std::string::npos);
    EXPECT_NE(text.find("cut short"), std::string::npos);
  }
}

// The signal is not ours, so it ends the program; a sanitizer that catches it says so and ends it too.
#if defined(__SANITIZE_ADDRESS__)
const ::testing::ExitedWithCode kEnded(1);
constexpr const char* kSays = "AddressSanitizer: BUS";
#else
const ::testing::KilledBySignal kEnded(SIGBUS);
constexpr const char* kSays = "";
#endif

TEST(MappedFile, BusErrorsOfOthersStayTheirs) {
  const std::string path = bigFile().string();
  EXPECT_EXIT(
      {
        const MappedFile ours(path, "ours");
        const int descriptor = ::memfd_create("other", 0);
        if (::ftruncate(descriptor, 8192) != 0) _exit(1);
        auto* theirs = static_cast<volatile char*>(::mmap(nullptr, 8192, PROT_READ, MAP_SHARED, descriptor, 0));
        if (::ftruncate(descriptor, 0) != 0) _exit(1);
        std::signal(SIGALRM, SIG_DFL);
        ::alarm(20);
        _exit(theirs[5000]);
      },
      kEnded, kSays);
}

TEST(MappedFile, WhatCannotBeMappedIsRefused) {
  const std::filesystem::path folder = testFolder();
  EXPECT_THROW(MappedFile((folder / "none").string(), "x"), InputError);
  EXPECT_THROW(MappedFile(folder.string(), "x"), InputError);
  EXPECT_THROW(MappedFile("/dev/zero", "x"), InputError);
  writeBytes(folder / "empty", "", 0);
  const MappedFile empty((folder / "empty").string(), "x");
  EXPECT_TRUE(empty.bytes().empty());
  empty.letGo(empty.bytes());
  empty.requireWhole();
}

}  // namespace
}  // namespace pellucid::test
