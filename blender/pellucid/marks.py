"""What is transparent, and what is shown to whom."""

import contextlib

from . import compat
from .trouble import Trouble


def names(scene):
    """Of the objects that are marked, or lie in a marked collection."""
    found = {each.name for collection in scene.collection.children_recursive if collection.pellucid_transparent
             for each in collection.all_objects}
    return found | {each.name for each in scene.objects if each.pellucid_transparent}


def rendered(view_layer):
    """Names of the objects that a render of the view layer would show."""
    def walk(layer):
        if layer.exclude or layer.collection.hide_render:
            return
        yield from (each.name for each in layer.collection.objects if not each.hide_render)
        for child in layer.children:
            yield from walk(child)

    return set(walk(view_layer.layer_collection))


def marked(scene, view_layer):
    """The marked objects that would be rendered. Raises Trouble for none."""
    wanted = names(scene)
    found = [each for each in scene.objects if each.name in wanted]
    if not found:
        raise Trouble("No object of the scene is marked as transparent: mark some in the Pellucid panel of the render "
                      "properties.")
    seen = rendered(view_layer)
    shown = [each for each in found if each.name in seen]
    if not shown:
        raise Trouble(f"All {len(found)} marked objects are hidden from renders: show those to be composited.")
    return shown


@contextlib.contextmanager
def only(scene, shown):
    """Hides from renders all objects that `shown` refuses, while it lasts."""
    hidden = [each for each in scene.objects if not each.hide_render and not shown(each)]
    for each in hidden:
        each.hide_render = True
    try:
        yield
    finally:
        for each in hidden:
            each.hide_render = False


def _is_closed(mesh):
    """Every edge has two faces."""
    faces = [0] * len(mesh.edges)
    for loop in mesh.loops:
        faces[loop.edge_index] += 1
    return bool(faces) and all(count == 2 for count in faces)


def _transmits(material):
    if not material or not material.node_tree:
        return False
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            socket = compat.transmission_of(node)
            if socket.is_linked or socket.default_value > 0:
                return True
    return False


def solid_materials(objects):
    """Names of materials with transmission, all of whose marked meshes are closed."""
    closed, open_ = set(), set()
    for each in objects:
        glass = [slot.material.name for slot in each.material_slots if _transmits(slot.material)]
        if glass and each.type == "MESH":
            (closed if _is_closed(each.data) else open_).update(glass)
    return sorted(closed - open_)
