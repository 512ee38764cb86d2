"""Flags that say where a run is watched in Rerun while it goes on."""

import dataclasses
from typing import Annotated

import typer

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.viz.viewers import PAGE_PORT, Viewers


@dataclasses.dataclass(frozen=True, kw_only=True)
class ViewerFlags:
    """Where a run is watched."""

    live: Annotated[bool, typer.Option("--live")] = False
    """Stream to a Rerun viewer while the scene runs."""
    connect: Annotated[str | None, typer.Option(metavar="HOST:PORT")] = None
    """Stream to the Rerun viewer that listens at this address."""
    serve: Annotated[bool, typer.Option("--serve")] = False
    """Serve Rerun's viewer to a browser, until Ctrl-C; through SSH too."""
    serve_port: int | None = None
    """Port of that page instead of 9090; the next one is taken too."""

    def __post_init__(self) -> None:
        if self.serve_port is not None and not self.serve:
            raise RecordingError("--serve-port is given without --serve; give both")

    @property
    def viewers(self) -> Viewers:
        """Where the run is watched."""
        port = (PAGE_PORT if self.serve_port is None else self.serve_port) if self.serve else None
        return Viewers(live=self.live, connect=self.connect, serve=port)
