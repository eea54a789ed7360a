#include "composite/cli/time_flags.h"

namespace pellucid::cli {

void TimeFlags::addTo(CLI::App& verb) {
  verb.add_option("--frame", frame,
                  "Frame whose pose the glTF takes, at frame / fps seconds; without it the one that the EXR's header "
                  "names, and without either the pose that the glTF stores");
  verb.add_option("--time", seconds, "Time of the glTF's animations in seconds, instead of a frame");
  verb.add_option("--fps", framesPerSecond, "Frames a second; without it the header's framesPerSecond, else 24");
  verb.add_option("--time-offset", offset, "Seconds added to a frame's time, for a glTF that begins at 0");
  verb.add_option("--animation", animations,
                  "Animation of the glTF to play, by name, and again for more; all: together, the later one where two "
                  "move the same; none: as the file stands. Without it all, where no two move the same, else the first")
      ->allow_extra_args(false);
}

ShotTime TimeFlags::time() const {
  return {frame, seconds, framesPerSecond, offset, animations};
}

}  // namespace pellucid::cli
