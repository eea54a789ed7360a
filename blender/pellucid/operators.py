"""What the panel's buttons do."""

import os
import time

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


_SECONDS = 0.2  # between looks at the running program


class PELLUCID_OT_composite(bpy.types.Operator):
    """Render the opaque part, export the transparent one, and let Pellucid composite it. Esc ends it"""

    bl_idname = "pellucid.composite"
    bl_label = "Render and composite"

    def execute(self, context):
        """Blender calls it where a script asks: the picture is there when it returns."""
        try:
            self._prepare(context)
            notes = self._finish(context, program.run(self._executable, self._words))
        except Trouble as trouble:
            return self._refuse(trouble)
        return self._report(notes)

    def invoke(self, context, _event):
        """Blender calls it where a button asks: it goes on while the program composites."""
        if bpy.app.background:
            return self.execute(context)
        try:
            self._prepare(context)
            self._running = program.Running(self._executable, self._words)
        except Trouble as trouble:
            return self._refuse(trouble)
        manager = context.window_manager
        self._began = time.monotonic()
        self._timer = manager.event_timer_add(_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Blender calls it for each event while the program composites."""
        if event.type == "ESC":
            self._running.stop()
            self._release(context)
            self.report({"WARNING"}, "Compositing was ended; what was rendered and exported is kept.")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not self._running.ended():
            seconds = time.monotonic() - self._began
            context.workspace.status_text_set(f"Pellucid composites: {seconds:.0f} s. Esc ends it.")
            return {"PASS_THROUGH"}
        self._release(context)
        try:
            notes = self._finish(context, self._running.notes())
        except Trouble as trouble:
            return self._refuse(trouble)
        return self._report(notes)

    def _release(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)

    def _refuse(self, trouble):
        self.report({"ERROR"}, str(trouble))
        return {"CANCELLED"}

    def _report(self, notes):
        for note in notes:
            self.report({"INFO"}, note)
        return {"FINISHED"}

    def _prepare(self, context):
        """Renders and exports, and sets what the program is to be called with. Raises Trouble."""
        scene = context.scene
        chosen = scene.pellucid
        transparent = marks.marked(scene, context.view_layer)
        stage.camera_of(scene)
        folder = _folder(chosen.folder)
        number = ".####" if chosen.animation else ""
        opaque, self._output = (os.path.join(folder, f"{name}{number}.exr") for name in ("opaque", "composited"))
        scenes = os.path.join(folder, "transparent.glb")
        self._frames = (scene.frame_start, scene.frame_end) if chosen.animation else None
        flags, self._notes = self._flags(context, transparent)
        self._executable = preferences.program(context)
        self._notes += program.check(self._executable, flags, self._output)
        self._first = scene.frame_start if chosen.animation else scene.frame_current
        if chosen.render_again or not (result.exists(result.file_of(opaque, self._first)) and result.exists(scenes)):
            stage.export_transparent(scene, context.view_layer, scenes, transparent, chosen.animation)
            stage.render_opaque(scene, context.view_layer, opaque, transparent, chosen.animation)
        self._words = ["composite", opaque, scenes, "--output", self._output, "--log-json", *flags,
                       *self._frame_words(scene)]

    def _finish(self, context, notes):
        """Shows the picture. Returns what there is to say."""
        image = result.show(result.file_of(self._output, self._first), self._frames)
        if context.scene.pellucid.compositor:
            result.into_compositor(context.scene, image, self._frames)
        return self._notes + notes + [f"Composited into {self._output}."]

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

    def _frame_words(self, scene):
        if not self._frames:
            return []
        rate = scene.render.fps / scene.render.fps_base
        return ["--frames", f"{self._frames[0]}-{self._frames[1]}x{scene.frame_step}", "--fps", f"{rate:.9g}"]
