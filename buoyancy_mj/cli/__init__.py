"""The command line: flags to a scene or a model, then for each frame: record. No physics."""

# each adds its commands, in this order of the help
from buoyancy_mj.cli import runs as runs  # isort: split

from buoyancy_mj.cli import inspections as inspections  # isort: split

from buoyancy_mj.cli import sweeps as sweeps  # isort: split

from buoyancy_mj.cli import papers as papers  # isort: split

from buoyancy_mj.cli import validations as validations  # isort: split

from buoyancy_mj.cli.common import app as app
