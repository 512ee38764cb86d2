"""The command line: no physics, and no file format of its own.

In: flags, and names of scenes and models.
Out: tables, JSON, recordings and pages, an exit status, and errors as one sentence.
May import: every other room.
"""

from buoyancy_mj.cli.group import app as app
