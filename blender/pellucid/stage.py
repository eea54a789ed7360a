"""The two files that the program reads: the render without the transparent objects, and these as a glTF."""

import contextlib
import os

import bpy

from . import compat, marks
from .trouble import Trouble


@contextlib.contextmanager
def _changed(owner, **values):
    """Attributes of `owner` for a while."""
    before = {name: getattr(owner, name) for name in values}
    try:
        for name, value in values.items():
            setattr(owner, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(owner, name, value)


@contextlib.contextmanager
def _multilayer(image_settings):
    names = ("file_format", "color_mode", "color_depth", "exr_codec")
    before = {name: getattr(image_settings, name) for name in names}
    try:
        compat.multilayer_format(image_settings)
        image_settings.color_mode, image_settings.color_depth, image_settings.exr_codec = "RGBA", "32", "ZIP"
        yield
    finally:
        for name, value in before.items():
            with contextlib.suppress(TypeError):  # a depth or codec that the format of before has not
                setattr(image_settings, name, value)


def render_opaque(scene, view_layer, path, transparent, animation):
    """Renders everything but `transparent` to a multilayer EXR with Combined and Depth, in floats. What was set before
    is set again. `path` has #### for the frame of an animation. Raises Trouble."""
    render = scene.render
    hidden = {each.name for each in transparent}
    with contextlib.ExitStack() as stack:
        stack.enter_context(marks.only(scene, lambda each: each.name not in hidden))
        stack.enter_context(_changed(render, filepath=path, use_compositing=False, use_sequencer=False,
                                     use_multiview=False, use_border=False, use_overwrite=True, use_stamp_frame=True))
        for layer in scene.view_layers:
            stack.enter_context(_changed(layer, use=layer == view_layer))
        stack.enter_context(_changed(view_layer, use_pass_combined=True, use_pass_z=True))
        stack.enter_context(_multilayer(render.image_settings))
        try:
            bpy.ops.render.render(animation=animation, write_still=not animation, scene=scene.name)
        except RuntimeError as error:
            raise Trouble(f"Blender could not render the opaque part: {str(error).strip()}") from error


def camera_of(scene):
    """The scene's camera, where a glTF can hold it. Raises Trouble."""
    camera = scene.camera
    if camera is None:
        raise Trouble("The scene has no active camera: expected the one that it is rendered from.")
    if camera.data.type not in ("PERSP", "ORTHO"):
        raise Trouble(f"The camera {camera.name} is panoramic: expected a perspective or orthographic one, which glTF "
                      "has.")
    if camera.data.shift_x or camera.data.shift_y:
        raise Trouble(f"The camera {camera.name} is shifted by {camera.data.shift_x:g}, {camera.data.shift_y:g}: "
                      "expected 0, 0, because glTF has no shifted cameras.")
    across, down = scene.render.pixel_aspect_x, scene.render.pixel_aspect_y
    if across != down:
        raise Trouble(f"Pixels are {across:g} to {down:g}: expected square ones, because the EXR that Blender writes "
                      "does not say.")
    return camera


def export_transparent(scene, view_layer, path, transparent, animation):
    """Writes these objects, the active camera and the lights as a GLB. Raises Trouble."""
    seen = marks.rendered(view_layer)
    names = {each.name for each in transparent} | {camera_of(scene).name}
    names |= {each.name for each in scene.objects if each.type == "LIGHT" and each.name in seen}
    arguments = dict(filepath=path, export_format="GLB", use_renderable=True, use_active_scene=True, export_apply=True,
                     export_cameras=True, export_lights=True, export_extras=False, export_yup=True,
                     export_animations=animation)
    with contextlib.ExitStack() as stack:
        stack.enter_context(marks.only(scene, lambda each: each.name in names))
        stack.enter_context(_changed(scene.camera, hide_render=False))
        try:
            bpy.ops.export_scene.gltf(**arguments, **compat.gltf_arguments(animation))
        except (RuntimeError, AttributeError) as error:
            raise Trouble("Blender could not export the transparent objects; is its add-on glTF 2.0 switched on? "
                          f"{str(error).strip()}") from error
    if not os.path.exists(path):
        raise Trouble(f"{path}: not there after Blender's glTF export, expected the transparent objects.")
