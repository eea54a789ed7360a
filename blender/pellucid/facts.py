"""What the scene says that neither of the two files does, as flags of the program."""

from . import compat, flags


def _colour(values, strength):
    return ",".join(f"{value * strength:.9g}" for value in values[:3])


def surroundings(scene):
    """R,G,B of a world of one colour; None for any other."""
    world = scene.world
    if world is None:
        return "0,0,0"
    if not world.use_nodes:
        return _colour(world.color, 1.0)
    shaders = [node for node in world.node_tree.nodes if node.type != "OUTPUT_WORLD"]
    if len(shaders) != 1 or shaders[0].type != "BACKGROUND":
        return None
    colour, strength = shaders[0].inputs["Color"], shaders[0].inputs["Strength"]
    return _colour(colour.default_value, strength.default_value)


def pixel_filter(scene):
    """The filter that the engine renders with; None where the program's own guess is as good."""
    if scene.render.engine == "CYCLES":
        if scene.cycles.pixel_filter_type == "BOX":
            return "box"
        if scene.cycles.pixel_filter_type == "BLACKMAN_HARRIS":
            return f"blackman-harris:{scene.cycles.filter_width:.6g}"
    elif compat.is_eevee(scene.render.engine):
        return f"blackman-harris:{scene.render.filter_size:.6g}"
    return None


def light_layers(scene, view_layer):
    """{light: layer} of lights that have a light group of the view layer to themselves: what their shadows dim."""
    groups = {}
    for each in [*scene.objects, *([scene.world] if scene.world else [])]:
        groups.setdefault(each.lightgroup, []).append(each)
    layers = {}
    for group in view_layer.lightgroups:
        members = groups.get(group.name, [])
        if len(members) == 1 and getattr(members[0], "type", "") == "LIGHT" and members[0].data.type != "AREA":
            layers[members[0].data.name] = f"{view_layer.name}.Combined_{group.name}"
    return layers


def words(scene, view_layer, chosen):
    """Flags that `chosen` does not give, and sentences about what was taken or not."""
    line, notes = [], []

    def given(name):
        return any(word == "--" + name or word.startswith(f"--{name}=") for word in chosen)

    if not given("environment"):
        colour = surroundings(scene)
        if colour:
            line += ["--environment", colour]
        else:
            notes.append("The world is no plain colour: give the surroundings as a lat-long EXR under Environment.")
    passes = chosen[chosen.index("--aa") + 1] if "--aa" in chosen else flags.row("aa")["default"]
    shape = pixel_filter(scene)
    if shape and not given("filter") and passes != "1":
        line += ["--filter", shape]
    if given("shadows") and not given("light"):
        for light, layer in light_layers(scene, view_layer).items():
            line += ["--light", f"{light}={layer}"]
    return line, notes
