"""`python -m buoyancy_mj`: the command line."""

from buoyancy_mj.cli import app

app()
