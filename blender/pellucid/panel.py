"""The panel in the render properties."""

import bpy

from . import marks, settings


class PELLUCID_PT_render(bpy.types.Panel):
    """What is transparent, how it is composited, and the button that does it."""

    bl_label = "Pellucid"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Blender calls it."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self._draw_marks(layout, context)
        chosen = context.scene.pellucid
        column = layout.column()
        for name in settings.WIDGETS:
            column.prop(chosen, settings.attribute(name))
        for name in ("more", "solid", "folder", "animation", "render_again", "compositor"):
            column.prop(chosen, name)
        layout.operator("pellucid.composite", icon="RENDER_STILL")

    @staticmethod
    def _draw_marks(layout, context):
        row = layout.row(align=True)
        row.operator("pellucid.mark", text="Mark selected").transparent = True
        row.operator("pellucid.mark", text="Unmark selected").transparent = False
        if context.collection and context.collection != context.scene.collection:
            layout.prop(context.collection, "pellucid_transparent", text=f"Collection {context.collection.name}")
        names = marks.names(context.scene)
        layout.label(text=f"Marked: {len(names)} of {len(context.scene.objects)} objects")
