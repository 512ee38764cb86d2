"""The first moments of the command line, before anything else is imported."""

import os
import sys

_NAME = "buoyancy_mj"


def _prepare() -> None:
    """Make this process safe, if it was started as the command line of this package.

    `python -m buoyancy_mj` looks for modules in the working folder first, where a file may have the
    name of any module that is imported. Ctrl-C during an import would leave a traceback.
    """
    if _is_module():
        if not sys.flags.safe_path:
            # where Python has put the working folder
            del sys.path[0]
    elif not os.path.basename("".join(sys.argv[:1])).startswith("buoyancy-mj"):
        return

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


def _is_module() -> bool:
    """Whether Python is looking for this package, as `-m` asked for it."""
    if sys.argv[:1] != ["-m"]:
        return False
    pairs = zip(sys.orig_argv, [*sys.orig_argv[1:], ""], strict=True)
    return any(
        option.startswith("-") and (option + name).partition("m")[2].split(".")[0] == _NAME
        for option, name in pairs
    )


_prepare()
