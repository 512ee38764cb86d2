"""Tables by which compiled code knows a water and where it works; see `entries.views`."""

from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Words
from buoyancy_mj.kernels.passes import LoadArrays
from buoyancy_mj.kernels.scratch import Scratch


class Links(NamedTuple):
    """C functions and other addresses; 0 for none."""

    model: int
    """The water's own mjModel."""
    signature: int
    """MuJoCo's compilation signature of that model."""
    sizes: int
    """The `sum_sizes` of its geoms, when the hulls were measured."""
    measure: int
    """A function that measures the hulls anew."""
    sizes_text: int
    """What the engine is told when a copy of the model has geoms of other sizes."""
    act: int
    """The C function `act`."""
    submerge: int
    """What finds the submersion of the hulls: `entries.loads.submerge`, or a function of Python."""
    augment: int
    """The C function `entries.loads.augment`; 0 where nothing has added mass."""
    inertia: int
    """The C function `entries.loads.add_inertia`; 0 likewise."""
    error: int
    """MuJoCo's mju_error."""
    gravity_text: int
    """What it is told when gravity is not along -z."""
    factor: int
    """MuJoCo's mj_factorM."""
    project: int
    """MuJoCo's mj_projectConstraint."""
    crew: int
    """Address of the `crews.Crew` that helps; 0 for none."""
    threads: int
    """How many threads work on one pass at most."""


class WaterTable(NamedTuple):
    """All that compiled code knows of a water."""

    loads: LoadArrays
    links: Links
    acting: Annotated[Words, ("n",)]
    """Addresses of the C functions of the loads that act, see `entries.loads`."""
    items: Annotated[Words, ("n",)]
    """How many items of each may be done side by side, see `passes.count_items`."""
    hulls: int
    """How many hulls may be submerged side by side."""
    offsets: int
    """Address of the byte offsets of `paths.PATHS`."""
    pool: Annotated[Words, ("p",)]
    """Addresses of a `Workplace` for each of several threads."""
    records: Annotated[Words, ("p",)]
    """Addresses of a record for each of the data that a callback acted on last."""
    datas: Annotated[Words, ("p",)]
    """Addresses of those data; 0 for none."""
    busy: Annotated[Words, ("p",)]
    """Addresses of words that are 1 while a thread fills the record."""
    turn: int
    """Address of the index of the record that the next data get."""


class Workplace(NamedTuple):
    """Where one thread works."""

    scratch: Scratch
    taken: int
    """Address of a word that is 1 while a thread works here."""


class Lease(NamedTuple):
    """What a callback of the engine is told, and told anew while it stays where it is."""

    previous: int
    """The callback that is called first; 0 for none."""
    water: int
    """Address of the word that holds the address of a `WaterTable`; 0 where no water is lent any
    more."""
    copies: int
    """1 to act on all models of the same compilation signature."""
