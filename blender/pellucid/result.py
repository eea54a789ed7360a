"""Shows the composited picture in Blender."""

import os

import bpy

from . import compat

NAME = "Pellucid"


def show(path, frames):
    """The picture as Blender's image `Pellucid`, in every open image editor.

    frames: (first, last) of a sequence that `path` is the first picture of; None for one picture.
    """
    image = bpy.data.images.get(NAME)
    if image is None:
        image = bpy.data.images.load(path)
        image.name = NAME
    image.filepath = path
    image.source = "SEQUENCE" if frames else "FILE"
    image.reload()
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image
    return image


def into_compositor(scene, image, frames):
    """The node `Pellucid` of the scene's compositor. Where the compositor was off it becomes what it gives."""
    tree, was_on = compat.compositor_tree(scene)
    node = tree.nodes.get(NAME)
    if node is None:
        node = tree.nodes.new("CompositorNodeImage")
        node.name = node.label = NAME
    node.image = image
    if frames:
        node.frame_start, node.frame_duration = frames[0], frames[1] - frames[0] + 1
        node.frame_offset = frames[0] - 1
    outputs = [node for node in tree.nodes if node.type == "COMPOSITE"]
    sockets = [socket for socket in node.outputs if socket.enabled]
    if not was_on and outputs and sockets:
        combined = next((socket for socket in sockets if socket.name in ("Combined", "Image")), sockets[0])
        tree.links.new(combined, outputs[0].inputs["Image"])


def file_of(pattern, frame):
    """The file of a frame: #### is its number."""
    return pattern.replace("####", f"{frame:04d}")


def exists(path):
    """Whether a file is there."""
    return os.path.isfile(path)
