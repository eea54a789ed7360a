// The most memory that the process has had since it was last asked to forget.
#pragma once
#include <cstddef>

namespace pellucid {

// Forgets what was resident before. False where the system cannot: then the peak is that of the whole process.
bool forgetPeakMemory();
// Bytes, libraries and the device's memory included; 0 where the system does not say.
std::size_t peakMemory();

}  // namespace pellucid
