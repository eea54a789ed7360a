#include "gbuffer/threads.h"

#include <OpenEXR/ImfThreading.h>

#include <mutex>
#include <thread>

#include "gbuffer/exr_header.h"

namespace pellucid {
namespace {
std::once_flag threadsAreSet;
}

void setExrThreads(int count) {
  std::call_once(threadsAreSet, [] {});
  exr::setGlobalThreadCount(count);
}

int exrThreads() {
  std::call_once(threadsAreSet, [] {
    // A host that uses OpenEXR itself has set its own count.
    if (exr::globalThreadCount() == 0) exr::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
  });
  return exr::globalThreadCount();
}

}  // namespace pellucid
