"""The command line: no physics, and no file format of its own.

In: flags, and names of scenes and models.
Out: tables, JSON, recordings and pages, an exit status, and errors as one sentence.
May import: every other room.
"""

# each adds its commands, in this order of the help
from buoyancy_mj.cli import runs as runs  # isort: split

from buoyancy_mj.cli import inspections as inspections  # isort: split

from buoyancy_mj.cli import ballasts as ballasts  # isort: split

from buoyancy_mj.cli import autopilots as autopilots  # isort: split

from buoyancy_mj.cli import sweeps as sweeps  # isort: split

from buoyancy_mj.cli import papers as papers  # isort: split

from buoyancy_mj.cli import validations as validations  # isort: split

from buoyancy_mj.cli.application import app as app
