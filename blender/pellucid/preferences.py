"""The add-on's preferences: where the program is."""

import shutil

import bpy


class PellucidPreferences(bpy.types.AddonPreferences):
    """Where the program is."""

    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The program pellucid; empty: the one on the search path")

    def draw(self, _context):
        """Blender calls it."""
        self.layout.prop(self, "program")
        if not self.program:
            self.layout.label(text=f"On the search path: {shutil.which('pellucid') or 'none'}")


def program(context):
    """What to run."""
    chosen = context.preferences.addons[__package__].preferences.program
    return bpy.path.abspath(chosen) if chosen else "pellucid"
