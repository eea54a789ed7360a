// How many threads EXR files are coded with.
#pragma once

namespace pellucid {

void setExrThreads(int count);  // >= 0; 0 codes on the calling thread

}  // namespace pellucid
