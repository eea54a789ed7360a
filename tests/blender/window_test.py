"""The button in a Blender with a window: it goes on with its own work while the program composites."""

import os
import stat
import sys
import traceback

import bpy
from blender_stage import FOLDER, PROGRAM, install, small_scene, switch_on, use_program

_TICK, _LATEST = 0.05, 1200  # seconds between looks, and how many of them are waited for
_OUTPUT = os.path.join(FOLDER, "shot", "composited.exr")
_SLOW = 5  # seconds that the program takes at least
_KEPT = {"ticks": 0, "steps": [], "window": None}


def slow(seconds):
    """A program that takes its time before it does what Pellucid does."""
    path = os.path.join(FOLDER, f"slow{seconds}")
    with open(path, "w", encoding="utf-8") as out:
        out.write(f"#!/bin/sh\n[ ! -f '{FOLDER}/shot/opaque.exr' ] || sleep {seconds}\nexec '{PROGRAM}' \"$@\"\n")
    os.chmod(path, stat.S_IRWXU)
    return path


def running():
    """Whether the picture is not shown yet."""
    return bpy.data.images.get("Pellucid") is None


def press():
    """Presses the button, as a user does."""
    with bpy.context.temp_override(window=_KEPT["window"]):
        return bpy.ops.pellucid.composite("INVOKE_DEFAULT")


def output():
    """Whether the picture is there."""
    return os.path.isfile(_OUTPUT)


def begin_slow():
    """The first run renders; the program then takes its time, in which Blender's own timers go on."""
    if output():
        os.remove(_OUTPUT)
    assert press() == {"RUNNING_MODAL"}, "the button waits for the program"
    _KEPT["ticks"] = 0


def end_slow():
    """As soon as the program has ended the picture is shown."""
    if running():
        return True
    # A button that waits lets none pass; drawn without a GPU a window has time for some in a second.
    assert _KEPT["ticks"] >= 5, f"Blender stood still: {_KEPT['ticks']} ticks in {_SLOW} seconds"
    assert output(), "no picture was written"
    assert bpy.path.abspath(bpy.data.images["Pellucid"].filepath) == _OUTPUT, "another picture is shown"
    return False


def steps():
    """One after another; each is asked again as long as it returns True."""
    _KEPT["window"] = bpy.context.window_manager.windows[0]
    use_program(slow(_SLOW))
    return [begin_slow, end_slow]


def tick():
    """Blender calls it, unless the button keeps it from that."""
    try:
        _KEPT["ticks"] += 1
        if _KEPT["window"] is None:
            _KEPT["steps"] = steps()
            return _TICK
        if _KEPT["ticks"] > _LATEST:
            raise AssertionError("it never ended")
        if not _KEPT["steps"]:
            print("the button lets Blender go on: right", flush=True)
            os._exit(0)
        if not _KEPT["steps"][0]():
            _KEPT["steps"].pop(0)
        return _TICK
    except BaseException:  # else Blender would go on for ever
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


if __name__ == "__main__":
    install()
    switch_on()
    small_scene().pellucid.compositor = False
    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)
