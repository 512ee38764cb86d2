"""`sitl`: an autopilot drives a vehicle."""

import dataclasses
import math
from collections.abc import Collection
from pathlib import Path
from typing import Annotated

import typer

from buoyancy_mj.autopilot.channels import Channel, connect, find_idle
from buoyancy_mj.autopilot.link import ANYWHERE, LOOPBACK, PORT, Link
from buoyancy_mj.autopilot.lockstep import fit_timestep
from buoyancy_mj.autopilot.motor_frames import MOTOR_FRAMES
from buoyancy_mj.autopilot.packets import Servos
from buoyancy_mj.autopilot.session import Session
from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import err, out, print_line
from buoyancy_mj.cli.flags import (
    Json,
    SceneArgument,
    SceneFlags,
    SelectionFlags,
    check_recording_name,
    check_table_name,
)
from buoyancy_mj.cli.recordings import Files, Recordings, StreamFlags
from buoyancy_mj.cli.summaries import print_files, summary_json, summary_table
from buoyancy_mj.cli.watching import ViewerFlags
from buoyancy_mj.errors import AutopilotError, choices
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.values import read_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class AutopilotFlags:
    """How an autopilot is heard, and how long."""

    frame: Annotated[str, typer.Option(metavar="FRAME")] = "vectored_6dof"
    """The autopilot's frame, whose motors find their thrusters by geometry; a wrong name lists
    them all."""
    map: Annotated[str | None, typer.Option(metavar="OUTPUT=NAME,...")] = None
    """Outputs of the autopilot and the actuators that they drive, as 1=bow,2=-stern; a minus turns
    the sense."""
    host: str | None = None
    """Listen on this address instead of 127.0.0.1; any other needs --expose."""
    port: int = PORT
    """Listen on this port."""
    expose: bool = False
    """Let others than this machine reach the simulation, and drive it."""
    rate: float | None = None
    """Step by 1/RATE s for each frame, whatever rate the autopilot asks for; the timestep becomes
    a whole part of it."""
    timeout: float = 60.0
    """End when the autopilot has been silent for so long [s]; 0 waits for ever."""
    duration: float | None = None
    """End after this simulated time [s]; otherwise the autopilot decides."""

    def __post_init__(self) -> None:
        if self.rate is not None:
            read_number(AutopilotError, "--rate", self.rate, least=1.0, most=1e5)
        if self.duration is not None:
            read_number(AutopilotError, "--duration", self.duration, above=0.0)
        read_number(AutopilotError, "--timeout", self.timeout, least=0.0)

    @property
    def patience(self) -> float | None:
        """How long the autopilot may be silent [s]; None for ever."""
        return self.timeout or None

    @property
    def until(self) -> float:
        """Simulated time after which to end [s]."""
        return math.inf if self.duration is None else self.duration

    def open(self) -> Link:
        """Listen."""
        host = self.host or (ANYWHERE if self.expose else LOOPBACK)
        return Link(host, self.port, expose=self.expose)


@command(
    examples=(
        "sitl bluerov2_heavy_dive --rate 400",
        "sitl my_scene.toml --port 9002 --record flight.rrd",
    ),
)
def sitl(
    scene: SceneArgument,
    flags: SceneFlags,
    selection: SelectionFlags,
    autopilot: AutopilotFlags,
    streams: StreamFlags,
    watching: ViewerFlags,
    record: Annotated[Path | None, typer.Option(help="Record to this file.")] = None,
    series: Annotated[
        Path | None,
        typer.Option(help="Write a row for each frame into this .csv or .parquet as well."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Let ArduPilot's software in the loop drive a vehicle, in lock-step over UDP.

    Of several vehicles in the scene, --vehicle names the one that is driven.
    """
    check_recording_name(record)
    check_table_name(series)
    watching.viewers.check()
    if autopilot.frame not in MOTOR_FRAMES:
        raise AutopilotError(
            f"unknown frame '{autopilot.frame}'; {choices(autopilot.frame, MOTOR_FRAMES)}"
        )
    plan, chosen = _read_plan(scene, flags, selection, autopilot.rate)
    starts = 0
    with autopilot.open() as link:
        packet: Servos | None = None
        while starts == 0 or packet is not None:
            starts += 1
            with err.status("preparing"):
                session = _prepare(plan, chosen, autopilot, trust=flags.trust)
            if packet is None:
                packet = _wait(link, autopilot)
            else:
                print_line(err, "the autopilot has started anew, and so does the scene")
            recordings = Recordings(
                session.simulation,
                number_recording(record, starts),
                number_recording(series, starts),
                viewers=watching.viewers,
                streams=dataclasses.replace(streams, mcap=number_recording(streams.mcap, starts)),
            )
            packet = _fly(session, link, packet, autopilot, recordings, as_json=as_json)


def _read_plan(
    scene: str, flags: SceneFlags, selection: SelectionFlags, rate: float | None
) -> tuple[Scene, str | None]:
    """The scene, and the name of the vehicle among several that is driven."""
    path = catalog.scene_path(scene)
    alone = dataclasses.replace(flags, vehicle=None)
    plan = read_scene(path, [*alone.overrides(), *selection.overrides()])
    chosen = flags.vehicle if plan.vehicles else None
    if flags.vehicle is not None and chosen is None:
        plan = read_scene(path, [*flags.overrides(), *selection.overrides()])
    if plan.vehicles:
        _check_choice(chosen, [str(entry.name) for entry in plan.vehicles])
    # what steered the vehicle in the scene gives way
    others = tuple(one for one in plan.control if one.vehicle not in (None, chosen))
    if len(others) < len(plan.control):
        print_line(err, "note: the scene's [control] of this vehicle rests", style="yellow")
        plan = dataclasses.replace(plan, control=others)
    if rate is not None:
        plan = dataclasses.replace(plan, timestep=fit_timestep(rate, plan.timestep))
    return plan, chosen


def _prepare(plan: Scene, chosen: str | None, autopilot: AutopilotFlags, *, trust: bool) -> Session:
    """A simulation at its start, with the outputs of the autopilot connected."""
    simulation = Simulation(plan, trust=trust)
    _check_choice(chosen, simulation.vehicles)
    vehicle = simulation.vehicle if chosen is None else simulation.vehicles[chosen]
    model = simulation.model
    channels = connect(model, vehicle, autopilot.frame, autopilot.map)
    _print_channels(vehicle, channels, find_idle(model, vehicle, channels))
    return Session(simulation, vehicle, channels, autopilot.rate)


def _check_choice(name: str | None, vehicles: Collection[str]) -> None:
    """Check that a name tells which vehicle is driven.

    Raises:
        AutopilotError: no name among several, or none of that name.
    """
    if name is None and len(vehicles) > 1:
        raise AutopilotError(
            f"the scene has {len(vehicles)} vehicles, and an autopilot drives one; name it "
            f"(--vehicle); {choices(name, vehicles)}"
        )
    if name is not None and name not in vehicles:
        raise AutopilotError(f"the scene has no vehicle '{name}'; {choices(name, vehicles)}")


def _print_channels(vehicle: Vehicle, channels: list[Channel], idle: list[str]) -> None:
    """Say what drives what."""
    print_line(err, f"outputs to actuators of '{vehicle.name}': {', '.join(map(str, channels))}")
    if idle:
        note = f"note: no output drives {', '.join(idle)}; --map may name one"
        print_line(err, note, style="yellow")


def _wait(link: Link, autopilot: AutopilotFlags) -> Servos:
    """Wait for the first packet.

    Raises:
        AutopilotError: none came.
    """
    print_line(err, f"listening for ArduPilot on {link.host}, port {link.port}")
    packet = link.receive(autopilot.patience)
    if packet is None:
        heard = f" ({link.malformed} packets were none of ArduPilot's)" if link.malformed else ""
        raise AutopilotError(
            f"no autopilot has sent anything to {link.host}, port {link.port}, for "
            f"{autopilot.timeout:g} s{heard}; start ArduPilot with --model JSON:{LOOPBACK}, or "
            "wait longer (--timeout)"
        )
    return packet


def _fly(
    session: Session,
    link: Link,
    packet: Servos,
    autopilot: AutopilotFlags,
    recordings: Recordings,
    *,
    as_json: bool,
) -> Servos | None:
    """Run until the autopilot is silent or starts anew, and sum up; the packet of its new start."""
    stop: KeyboardInterrupt | None = None
    try:
        try:
            packet_of_next = session.fly(
                link,
                patience=autopilot.patience,
                first=packet,
                duration=autopilot.until,
                add=recordings.add if recordings else None,
            )
        except KeyboardInterrupt as interrupt:
            # the usual end of a session
            stop, packet_of_next = interrupt, None
        files = recordings.close(session.summary())
    except BaseException:
        recordings.keep(session.summary)
        raise
    if packet_of_next is None and stop is None and not session.is_over(autopilot.until):
        print_line(err, f"the autopilot has been silent for {autopilot.timeout:g} s")
    _sum_up(session, link, files, as_json=as_json)
    if stop is not None:
        raise stop
    return packet_of_next


def _sum_up(session: Session, link: Link, files: Files, *, as_json: bool) -> None:
    """Print the summary of a session."""
    counts = {
        "frames": session.frames,
        "asked_rate": session.asked_rate,
        "lost_frames": session.lockstep.lost,
        "repeated_packets": session.lockstep.repeated + link.skipped,
        "malformed_packets": link.malformed,
    }
    link.count_anew()
    if as_json:
        typer.echo(summary_json(session.summary(), files, {"autopilot": counts}))
        return
    table = summary_table(session.summary())
    several = len(session.simulation.vehicles) > 1
    if not several:
        for name, value in counts.items():
            table.add_row(name.replace("_", " "), f"{value}{' Hz' if name == 'asked_rate' else ''}")
    out.print(table)
    if several:
        print_line(out, ", ".join(f"{name.replace('_', ' ')} {n}" for name, n in counts.items()))
    print_files(files)


def number_recording(path: Path | None, start: int) -> Path | None:
    """The name of the recording of a start: NAME.rrd, NAME-2.rrd and so on."""
    if path is None or start == 1:
        return path
    return path.with_name(f"{path.stem}-{start}{path.suffix}")
