"""What machine a run was measured on."""

import datetime
import os
import platform
from importlib import metadata
from pathlib import Path

import llvmlite.binding as llvm
from numba import config

Machine = dict[str, str]
"""What is told of a machine and of a run, by name."""
_CACHES = Path("/sys/devices/system/cpu/cpu0/cache")
_VECTORS = {"avx512f": "AVX-512", "avx2": "AVX2", "avx": "AVX", "neon": "NEON"}
"""What the features of processors are called, the widest vectors first."""


def describe_machine() -> Machine:
    """This machine, what kernels are compiled for, versions, and the day."""
    versions = {name: metadata.version(name) for name in ("mujoco", "numba", "numpy")}
    return {
        "processor": _read_processor(),
        "cores": str(os.cpu_count()),
        "vectors": _find_vectors(),
        "compiled for": config.CPU_NAME or llvm.get_host_cpu_name(),
        "second cache of a core": _read_cache(),
        "python": platform.python_version(),
        **versions,
        "day": datetime.date.today().isoformat(),
    }


def _read_processor() -> str:
    """The processor's name; on Linux Python knows the architecture alone."""
    cpus = Path("/proc/cpuinfo")
    if cpus.is_file():
        for line in cpus.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _find_vectors() -> str:
    """The widest vectors that kernels are compiled for."""
    if config.CPU_FEATURES is None:
        features = [name for name, has in llvm.get_host_cpu_features().items() if has]
    else:
        features = [text[1:] for text in config.CPU_FEATURES.split(",") if text.startswith("+")]
    return next((called for name, called in _VECTORS.items() if name in features), "none")


def _read_cache() -> str:
    """The size of the second cache of the first core, as the system tells it."""
    for cache in sorted(_CACHES.glob("index*")):
        if (cache / "level").read_text().strip() == "2":
            return (cache / "size").read_text().strip()
    return "unknown"
