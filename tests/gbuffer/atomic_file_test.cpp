// A file appears whole or not at all, whatever ends the run.
#include "gbuffer/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "exr_files.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/threads.h"

namespace pellucid::test {
namespace {

// A forked process has no worker threads: the parent puts its own away, and the child starts new ones.
struct WithoutThreads {
  WithoutThreads() { setExrThreads(0); }
  ~WithoutThreads() { setExrThreads(2); }
};

// Runs the work in a process of its own; its exit status, or 1000 + signal.
template <class Work>
int inChild(Work work) {
  const WithoutThreads parent;
  const pid_t child = fork();
  if (child == 0) {
    setExrThreads(2);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

ExtraLayer noise(int width, int height) {
  Image<float> plane(width, height);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane[i] = static_cast<float>((state = state * 1664525u + 1013904223u) >> 8);
  return {"noise", {{"R", plane}}};
}

TEST(AtomicFile, AppearsOnCommit) {
  TemporaryFolder folder;
  const std::string target = folder.path("out.bin");
  spit(target, "old");
  chmod(target.c_str(), 0640);
  {
    AtomicFile file(target);
    spit(file.temporary(), "new");
    EXPECT_EQ(slurp(target), "old");
    EXPECT_EQ(folder.list().size(), 2u);
    file.commit();
    EXPECT_EQ(slurp(target), "new");
  }
  struct stat info {};
  stat(target.c_str(), &info);
  EXPECT_EQ(info.st_mode & 0777, 0640u) << "permissions stay";
  { AtomicFile file(target); }
  EXPECT_EQ(slurp(target), "new") << "without commit nothing happens";
  EXPECT_EQ(folder.list(), std::vector<std::string>{"out.bin"});
}

TEST(AtomicFile, ReplacesWhatALinkPointsTo) {
  TemporaryFolder folder;
  spit(folder.path("real"), "old");
  ASSERT_EQ(symlink("real", folder.path("link").c_str()), 0);
  AtomicFile file(folder.path("link"));
  spit(file.temporary(), "new");
  file.commit();
  EXPECT_EQ(slurp(folder.path("real")), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link")));
}

TEST(AtomicFile, RefusesWhatCannotBeReplaced) {
  TemporaryFolder folder;
  const auto message = [](const std::string& target) -> std::string {
    try {
      AtomicFile file(target);
    } catch (const ResourceError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("/dev/full").find("/dev/full: cannot be written: found a device"), std::string::npos);
  EXPECT_NE(message(folder.path("")).find("found a folder"), std::string::npos);
  EXPECT_NE(message(folder.path("none/out.exr")).find("No such file"), std::string::npos);
  EXPECT_NE(message("").find("without a name"), std::string::npos);
  EXPECT_NE(message("/proc/out.exr"), "") << "a folder that nobody can write";
}

// A limit on the size of files fails writes just where a full disk would (EFBIG for ENOSPC).
TEST(AtomicFile, FullDiskLeavesTheOldFileAndNoDebris) {
  TemporaryFolder folder;
  const std::string target = folder.path("out.exr");
  const Window window{0, 0, 256, 256};
  const ExtraLayer layer = noise(256, 256);
  writeLayers(target, window, window, {layer});
  const std::size_t size = slurp(target).size();
  ASSERT_GT(size, 100000u);
  TemporaryFolder elsewhere;
  spit(elsewhere.path("in.exr"), slurp(target));
  const ExrDocument document = readExr(elsewhere.path("in.exr"));
  spit(target, "old");
  int failures = 0;
  for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, size / 3, size / 2, size - 1, size}) {
    for (const bool copy : {false, true}) {
      const int status = inChild([&] {
        cleanUpOnSignals();
        const rlimit limits{limit, limit};
        setrlimit(RLIMIT_FSIZE, &limits);
        try {
          if (copy)
            writeExr(folder.path("copy.exr"), document);
          else
            writeLayers(target, window, window, {layer});
        } catch (const Error& error) {
          const bool named = std::string(error.what()).find("cannot be written: File too large") != std::string::npos;
          return named ? error.exitCode() : 99;
        }
        return 0;
      });
      EXPECT_EQ(status, limit < size ? 6 : 0) << limit << " of " << size << (copy ? ", copied" : "");
      failures += status == 6;
    }
    if (limit < size) {
      EXPECT_EQ(slurp(target), "old");
      EXPECT_EQ(folder.list(), std::vector<std::string>{"out.exr"}) << "debris";
    }
  }
  EXPECT_EQ(failures, 10);
  EXPECT_EQ(slurp(target).size(), size);
}

TEST(AtomicFile, SignalsRemoveTheTemporaryFile) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    TemporaryFolder folder;
    spit(folder.path("out"), "old");
    const int status = inChild([&, number = signal] {
      cleanUpOnSignals();
      AtomicFile file(folder.path("out")), other(folder.path("more"));
      { AtomicFile done(folder.path("gone")); }
      spit(file.temporary(), "half of it");
      raise(number);
      return 0;
    });
    EXPECT_EQ(status, code);
    EXPECT_EQ(folder.list(), std::vector<std::string>{"out"});
    EXPECT_EQ(slurp(folder.path("out")), "old");
  }
}

// Interrupted at any moment of a real write, by another process: the old file or the new one, and nothing else.
TEST(AtomicFile, InterruptedWritesLeaveOldOrNew) {
  TemporaryFolder folder;
  const std::string target = folder.path("out.exr");
  const Window window{0, 0, 512, 512};
  const ExtraLayer layer = noise(512, 512);
  writeLayers(target, window, window, {layer});
  const std::string whole = slurp(target);
  const WithoutThreads parent;
  int interrupted = 0, replaced = 0;
  for (int delay = 0; delay < 40; ++delay) {
    spit(target, "old");
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
      setExrThreads(2);
      cleanUpOnSignals();
      if (write(ready[1], "x", 1) != 1) _exit(1);
      for (;;) writeLayers(target, window, window, {layer});
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
    usleep(static_cast<useconds_t>(500 * (delay + 1)));
    kill(child, SIGTERM);
    int status = 0;
    waitpid(child, &status, 0);
    interrupted += WIFEXITED(status) && WEXITSTATUS(status) == 143;
    const std::string found = slurp(target);
    EXPECT_TRUE(found == "old" || found == whole) << found.size() << " bytes after " << delay;
    replaced += found == whole;
    EXPECT_EQ(folder.list(), std::vector<std::string>{"out.exr"}) << "debris";
  }
  printf("interrupted writes: %d of 40 ended with 143, %d after a whole write\n", interrupted, replaced);
  EXPECT_EQ(interrupted, 40);
  EXPECT_LT(replaced, 40) << "none was interrupted in its first write";
}

}  // namespace
}  // namespace pellucid::test
