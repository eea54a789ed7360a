"""What differs between versions of Blender, and nothing else. Debian 12 has 3.4; what newer ones need is written from
their release notes."""

import bpy

_VERSION = bpy.app.version


def gltf_arguments(animated):
    """Arguments of the glTF exporter that newer versions name differently."""
    arguments = {"export_current_frame": not animated}
    if _VERSION >= (3, 6):
        arguments["export_animation_mode"] = "SCENE"
    else:
        arguments["export_nla_strips"] = False  # one animation of all that moves, in place of one for each object
    return arguments


def multilayer_format(image_settings):
    """Sets a multilayer EXR."""
    if _VERSION >= (5, 0):
        image_settings.media_type = "MULTI_LAYER_IMAGE"
    image_settings.file_format = "OPEN_EXR_MULTILAYER"


def transmission_of(principled):
    """The transmission socket of a Principled BSDF."""
    return principled.inputs["Transmission Weight" if _VERSION >= (4, 0) else "Transmission"]


def is_eevee(engine):
    """Whether a scene's engine is Eevee, old or new."""
    return engine.startswith("BLENDER_EEVEE")


def compositor_tree(scene):
    """The scene's compositing nodes, switched on; and whether they were before."""
    if _VERSION >= (5, 0):
        was = scene.compositing_node_group is not None
        if not was:
            scene.compositing_node_group = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
        return scene.compositing_node_group, was
    was = scene.use_nodes
    scene.use_nodes = True
    return scene.node_tree, was
