// The desktop's viewer of files.
#pragma once
#include <string>

namespace pellucid::cli {

bool hasDisplay();  // X11's or Wayland's
// Opens it as the desktop does. Throws ResourceError where no program takes it.
void openInViewer(const std::string& path);

}  // namespace pellucid::cli
