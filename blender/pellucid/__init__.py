"""Pellucid in Blender: transparent things are composited onto the render of everything else."""

bl_info = {
    "name": "Pellucid",
    "author": "Pellucid Developers",
    "version": (0, 0, 0),  # the program's, written when the add-on is packed
    "blender": (3, 4, 0),
    "location": "Properties > Render > Pellucid",
    "description": "Composites glass, smoke and foliage onto the render of everything else",
    "category": "Render",
}

import bpy  # noqa: E402  Blender reads bl_info without running the rest

from . import operators, panel, preferences, settings  # noqa: E402

_CLASSES = (preferences.PellucidPreferences, settings.PellucidSettings, operators.PELLUCID_OT_mark,
            operators.PELLUCID_OT_composite, panel.PELLUCID_PT_render)


def register():
    for each in _CLASSES:
        bpy.utils.register_class(each)
    settings.add_to_blender()


def unregister():
    settings.remove_from_blender()
    for each in reversed(_CLASSES):
        bpy.utils.unregister_class(each)
