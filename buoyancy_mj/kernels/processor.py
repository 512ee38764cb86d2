"""The processor that kernels are compiled for: two of different kinds may round differently."""

import functools

import llvmlite.binding as llvm
import numba
from numba.core import config


@functools.cache
def describe_processor() -> str:
    """The name and the features of that processor, and the version of the compiler."""
    name = config.CPU_NAME or llvm.get_host_cpu_name()
    features = config.CPU_FEATURES
    if features is None:
        features = llvm.get_host_cpu_features().flatten()
    return f"{name} {features} Numba {numba.__version__}"
