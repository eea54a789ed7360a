"""What the panel's buttons do."""

import os

import bpy

from . import facts, marks, preferences, program, result, settings, stage
from .trouble import Trouble


class PELLUCID_OT_mark(bpy.types.Operator):
    """Mark the selected objects as transparent, or take their mark away"""

    bl_idname = "pellucid.mark"
    bl_label = "Mark selected objects"
    bl_options = {"REGISTER", "UNDO"}

    transparent: bpy.props.BoolProperty(default=True)

    def execute(self, context):
        """Blender calls it."""
        for each in context.selected_objects:
            each.pellucid_transparent = self.transparent
        return {"FINISHED"}


def _folder(chosen):
    """The output folder, made where it is missing. Raises Trouble."""
    if chosen.startswith("//") and not bpy.data.filepath:
        raise Trouble(f"The file is not saved, and the folder {chosen} lies beside it: save the file, or choose a "
                      "folder that does not begin with //.")
    folder = os.path.abspath(bpy.path.abspath(chosen))
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise Trouble(f"{folder}: cannot be made: {error.strerror}.") from error
    return folder


class PELLUCID_OT_composite(bpy.types.Operator):
    """Render the opaque part, export the transparent one, and let Pellucid composite it"""

    bl_idname = "pellucid.composite"
    bl_label = "Render and composite"

    def execute(self, context):
        """Blender calls it."""
        try:
            notes = self._composite(context)
        except Trouble as trouble:
            self.report({"ERROR"}, str(trouble))
            return {"CANCELLED"}
        for note in notes:
            self.report({"INFO"}, note)
        return {"FINISHED"}

    def _composite(self, context):
        scene = context.scene
        chosen = scene.pellucid
        transparent = marks.marked(scene, context.view_layer)
        stage.camera_of(scene)
        folder = _folder(chosen.folder)
        number = ".####" if chosen.animation else ""
        opaque, output = (os.path.join(folder, f"{name}{number}.exr") for name in ("opaque", "composited"))
        scenes = os.path.join(folder, "transparent.glb")
        frames = (scene.frame_start, scene.frame_end) if chosen.animation else None
        flags, notes = self._flags(context, transparent)
        executable = preferences.program(context)
        notes += program.check(executable, flags, output)
        first = scene.frame_start if chosen.animation else scene.frame_current
        if chosen.render_again or not (result.exists(result.file_of(opaque, first)) and result.exists(scenes)):
            stage.export_transparent(scene, context.view_layer, scenes, transparent, chosen.animation)
            stage.render_opaque(scene, context.view_layer, opaque, transparent, chosen.animation)
        notes += program.run(executable, ["composite", opaque, scenes, "--output", output, "--log-json", *flags,
                                          *self._frames(scene, frames)])
        image = result.show(result.file_of(output, first), frames)
        if chosen.compositor:
            result.into_compositor(scene, image, frames)
        return notes + [f"Composited into {output}."]

    @staticmethod
    def _flags(context, transparent):
        """What the panel says, and the scene; with notes. Raises Trouble."""
        words = settings.words(context.scene.pellucid)
        more, notes = facts.words(context.scene, context.view_layer, words)
        words += more
        if context.scene.pellucid.solid:
            for name in marks.solid_materials(transparent):
                words += ["--set", f"{name}.thin=false"]
        return words, notes

    @staticmethod
    def _frames(scene, frames):
        if not frames:
            return []
        rate = scene.render.fps / scene.render.fps_base
        return ["--frames", f"{frames[0]}-{frames[1]}x{scene.frame_step}", "--fps", f"{rate:.9g}"]
