"""Lights, floor, background and off-screen buffer for pictures of the car."""

import mujoco

FARTHEST = 120.0
"""Maximum distance from the camera that is drawn [m]."""

FLOOR_COLOUR = (0.78, 0.80, 0.82, 1.0)
BACKGROUND = (0.80, 0.825, 0.85)


def add_studio(spec: mujoco.MjSpec, size: tuple[int, int], samples: int, ground: float) -> None:
    """Add lights, floor and background to a specification, without mass and without contact.

    Args:
        spec: specification with its shapes; changed in place.
        size: width and height of the largest picture [pixel].
        samples: multisampling of the picture.
        ground: height of the floor [m].
    """
    spec.visual.global_.offwidth, spec.visual.global_.offheight = size
    spec.visual.global_.fovy = 32.0
    spec.visual.quality.offsamples = samples
    # Nodes and members of the wireframe are thin; round ones would cost more than the whole car.
    spec.visual.quality.numslices, spec.visual.quality.numstacks = 10, 4
    spec.visual.quality.numquads = 1  # faces of a box: all light is parallel, so more would look the same
    spec.visual.headlight.ambient = [0.36, 0.37, 0.39]
    spec.visual.headlight.diffuse = [0.22, 0.22, 0.22]
    spec.visual.headlight.specular = [0.05, 0.05, 0.05]
    spec.visual.map.znear = 0.01
    spec.visual.map.haze = 0.3
    spec.visual.rgba.haze = [*BACKGROUND, 1.0]
    spec.stat.extent = 4.0
    spec.visual.map.zfar = FARTHEST / spec.stat.extent
    spec.stat.center = [2.2, 0.0, 0.9]
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=BACKGROUND,
        rgb2=BACKGROUND,
        width=8,
        height=48,
    )
    spec.add_material(name="floor", rgba=FLOOR_COLOUR, specular=0.1, shininess=0.2)
    # Four squares: an infinite plane would be 40 000 of them.
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[1.1 * FARTHEST] * 3,
        pos=[0.0, 0.0, ground],
        material="floor",
        contype=0,
        conaffinity=0,
    )
    for direction, diffuse in (
        ((0.55, -0.5, -0.75), (0.62, 0.61, 0.58)),
        ((-0.5, 0.55, -0.5), (0.22, 0.235, 0.26)),
        ((0.1, -1.0, -0.12), (0.16, 0.16, 0.16)),
    ):
        spec.worldbody.add_light(
            dir=direction,
            type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
            diffuse=diffuse,
            specular=[0.15, 0.15, 0.15],
            castshadow=False,
        )
