// What becomes of the memory of planes that are freed.
#pragma once

namespace pellucid::cli {

// Whole planes go back to the system when they are freed, so that a process takes no more memory than what is in use.
void givePlanesBack();

// They are kept for the next ones of their size: frames that follow one another ask for the same planes again and
// again, and the system would clear each of them anew.
void keepPlanes();

}  // namespace pellucid::cli
