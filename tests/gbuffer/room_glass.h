// Two sheets of glass for the room: one a little before all that is seen of it, one a little behind. Depth that is read
// wrong hides the one or shows the other.
#pragma once
#include <string>

#include "room.h"

namespace pellucid::test {

// Green before and red behind, each of which covers half; with the room's camera.
void writeRoomGlass(const std::string& path, const Room& room);

}  // namespace pellucid::test
