"""What the panel sets: of a scene, and the marks of objects and collections. Widgets of the program's flags are made of
its own table, so that their texts and defaults are those of --help."""

import re
import shlex

import bpy

from . import flags
from .trouble import Trouble

# In the order of the panel.
WIDGETS = ("method", "tolerance", "aa", "edges", "precision", "shadows", "environment")


def attribute(name):
    """The setting of a flag."""
    return "flag_" + name.replace("-", "_")


def _methods(_self, _context, typed):
    return [(method["name"], method["help"]) for method in flags.METHODS if typed in method["name"]]


def _widget(name):
    row = flags.row(name)
    label = name.upper() if len(name) == 2 else name.replace("-", " ").capitalize()
    common = {"name": label, "description": row["help"].rstrip(".")}
    if row["choices"]:
        items = [(choice, choice, "") for choice in row["choices"]]
        return bpy.props.EnumProperty(items=items, default=row["default"], **common)
    limits = re.search(r"INT.* in \[(\d+) - (\d+)\]", row["type"])
    if limits and row["default"]:
        least, most = map(int, limits.groups())
        return bpy.props.IntProperty(min=least, max=most, default=int(row["default"]), **common)
    if name == "method":
        common["search"] = _methods
        common["search_options"] = {"SORT", "SUGGESTION"}
    return bpy.props.StringProperty(default=row["default"], **common)


class PellucidSettings(bpy.types.PropertyGroup):
    """Settings of a scene."""

    __annotations__ = {attribute(name): _widget(name) for name in WIDGETS}
    __annotations__.update(
        folder=bpy.props.StringProperty(
            name="Folder", subtype="DIR_PATH", default="//pellucid/",
            description="Where opaque.exr, transparent.glb and composited.exr go; // is the folder of the .blend file"),
        more=bpy.props.StringProperty(
            name="More flags", description="Further flags of pellucid composite, as on a command line"),
        animation=bpy.props.BoolProperty(
            name="Animation", description="All frames of the scene's range instead of the current one"),
        render_again=bpy.props.BoolProperty(
            name="Render the opaque part", default=True,
            description="Off: take opaque.exr and transparent.glb of the last time, and composite again"),
        solid=bpy.props.BoolProperty(
            name="Closed glass is solid", default=True,
            description="Materials with transmission on closed meshes refract as Cycles has them; off: they are thin "
            "unless the glTF Material Output group gives them a thickness"),
        compositor=bpy.props.BoolProperty(
            name="Into the compositor", description="Also show the result as the node Pellucid of the compositor"),
    )


def words(settings):
    """The flags that differ from the program's defaults, as words of a command line. Raises Trouble."""
    line = []
    for name in WIDGETS:
        value = str(getattr(settings, attribute(name)))
        if value != flags.row(name)["default"]:
            line += [flags.row(name)["flag"], value]
    try:
        return line + shlex.split(settings.more)
    except ValueError as error:
        raise Trouble(f"More flags: found {settings.more!r}, which is no command line: {error}.") from error


def add_to_blender():
    """Gives scenes their settings, objects and collections their mark."""
    mark = {"name": "Transparent", "description": "Leave it out of the render and let Pellucid composite it"}
    bpy.types.Scene.pellucid = bpy.props.PointerProperty(type=PellucidSettings)
    bpy.types.Object.pellucid_transparent = bpy.props.BoolProperty(**mark)
    bpy.types.Collection.pellucid_transparent = bpy.props.BoolProperty(**mark)


def remove_from_blender():
    """Takes them away again; values stay in the file, as those of any add-on that is switched off."""
    del bpy.types.Collection.pellucid_transparent
    del bpy.types.Object.pellucid_transparent
    del bpy.types.Scene.pellucid
