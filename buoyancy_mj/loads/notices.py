"""What whoever waits is told."""

import functools


@functools.cache
def tell_of_potential_flow() -> None:
    """Say once, on the standard error, that added mass takes its time."""
    # only whoever waits waits for this import
    from rich.console import Console

    Console(stderr=True, highlight=False).print(
        "buoyancy_mj: solving the flow around bodies for their added mass, once for each shape",
        soft_wrap=True,
    )
