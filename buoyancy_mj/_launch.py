"""The first moments of the command line, before anything else is imported."""

import os
import sys

_NAME = "buoyancy_mj"


def _prepare() -> bool:
    """Make this process safe if it was started as our command line; say whether it was.

    `python -m buoyancy_mj` looks for modules in the working folder first, where a file may have the
    name of any module that is imported. Ctrl-C during an import would leave a traceback, or go by.
    """
    is_module = _is_module()
    if not is_module and not os.path.basename("".join(sys.argv[:1])).startswith("buoyancy-mj"):
        return False
    if is_module and not sys.flags.safe_path:
        # where Python has put the working folder
        del sys.path[0]
    _drop_empty_parts()
    # for other processes: glfw starts a Python to look at its library
    os.environ["PYTHONSAFEPATH"] = "1"
    # and only the viewer needs that, which asks for it itself
    os.environ.setdefault("MUJOCO_GL", "disable")

    # Numba obeys a .numba_config.yaml in the working folder, but not against the environment
    for name in ("NUMBA_CACHE_DIR", "NUMBA_CACHE_LOCATOR_CLASSES"):
        os.environ.setdefault(name, "")

    # only now, lest it be a file of the working folder
    import signal
    import warnings

    # what is told during an import, as all is told afterwards
    warnings.formatwarning = lambda message, *_, **__: f"note: {message}\n"
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # some modules catch whatever is raised while they are imported
        signal.signal(signal.SIGINT, lambda *_: os._exit(130))
    return is_module or _is_script()


def _drop_empty_parts() -> None:
    """Take empty parts out of PYTHONPATH, for Python takes them for the working folder.

    `export PYTHONPATH=$PYTHONPATH:/opt/mine` leaves one where there was no PYTHONPATH.
    """
    parts = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    named = [part for part in parts if part]
    if not named or len(named) == len(parts):
        return
    os.environ["PYTHONPATH"] = os.pathsep.join(named)
    here = os.getcwd()
    if here in sys.path and here not in map(os.path.abspath, named):
        sys.path.remove(here)


def _is_module() -> bool:
    """Whether Python is looking for this package, as `-m` asked for it."""
    if sys.argv[:1] != ["-m"]:
        return False
    pairs = zip(sys.orig_argv, [*sys.orig_argv[1:], ""], strict=True)
    return any(
        option.startswith("-")
        and (option.partition("m")[2] or name * option.endswith("m")).split(".")[0] == _NAME
        for option, name in pairs
    )


def _is_script() -> bool:
    """Whether the script that pip has installed runs, not another whose name begins as its.

    A process that such a script spawns is given its arguments, but was not started with them.
    """
    script = "".join(sys.argv[:1])
    is_ours = os.path.basename(script).removesuffix(".exe") == "buoyancy-mj"
    return is_ours and script in sys.orig_argv


IS_COMMAND_LINE = _prepare()
"""Whether this process is the command line of this package."""
