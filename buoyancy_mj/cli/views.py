"""`view`: a scene or a model on the screen, in water that can be changed while it runs."""

from pathlib import Path
from typing import Annotated

import typer

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.flags import SceneFlags, SelectionFlags
from buoyancy_mj.errors import SceneError, choices, describe
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.scenes.simulation import Simulation

RENDERERS = ("studio", "classic")
LOOPBACK = "127.0.0.1"
"""The address that this machine alone reaches."""
LAST_PORT = 65535


@command(
    examples=(
        "view auv_waves",
        "view fleet --web --port 8080",
    ),
)
def view(
    scene: Annotated[
        str,
        typer.Argument(
            help="A scene file (.toml), the name of a scene that ships, see 'list'; or the file of "
            "a model (.xml, .urdf), which the panel can put into water."
        ),
    ],
    flags: SceneFlags,
    selection: SelectionFlags,
    web: Annotated[
        bool, typer.Option("--web", help="Serve it to a browser instead of opening a window.")
    ] = False,
    host: Annotated[
        str, typer.Option(help="Address on which to serve; others than this machine's see it too.")
    ] = LOOPBACK,
    port: Annotated[
        int, typer.Option(help="Port on which to serve; 0 for the first free one from 8080 on.")
    ] = 0,
    renderer: Annotated[
        str, typer.Option(help="MuJoCo's studio, or its classic viewer.", metavar="studio|classic")
    ] = RENDERERS[0],
) -> None:
    """Show a scene in MuJoCo's Studio or in a browser, and change its water as it runs."""
    if renderer not in RENDERERS:
        raise SceneError(f"--renderer is {describe(renderer)}; {choices(renderer, RENDERERS)}")
    if not 0 <= port <= LAST_PORT:
        raise SceneError(
            f"--port is {port}; it must be from 1 to {LAST_PORT}, or 0 for the first free one"
        )
    settings = [*flags.overrides(), *selection.overrides()]
    if renderer == "classic":
        _view_classic(scene, settings, flags, web=web)
        return
    from buoyancy_mj.studio.view import view_in_studio

    shown: Scene | Path
    if Path(scene).suffix in catalog.MODEL_ENDINGS:
        if settings:
            raise SceneError(
                f"{describe(settings[0])} changes a scene, and '{scene}' is a model; leave it "
                f"out, or put the model into a scene: view SCENE --vehicle {scene}"
            )
        shown = catalog.model_path(scene)
    else:
        shown = read_scene(catalog.scene_path(scene), settings)
    view_in_studio(shown, web=web, host=host, port=port, trust=flags.trust)


def _view_classic(scene: str, settings: list[str], flags: SceneFlags, *, web: bool) -> None:
    """Show a scene in MuJoCo's classic viewer."""
    if web:
        raise SceneError("--web needs --renderer studio; the classic viewer has windows alone")
    from buoyancy_mj.viz.viewer import view_simulation

    read = read_scene(catalog.scene_path(scene), settings)
    view_simulation(Simulation(read, trust=flags.trust))
