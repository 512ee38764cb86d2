import collections
import mmap
from pathlib import Path

import pytest

from buoyancy_mj.kernels.scratch import new_scratches


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read as in Linux")
def test_scratch_that_nobody_writes_to_costs_no_memory_as_waters_come_and_go():
    def resident():
        return int(Path("/proc/self/statm").read_text().split()[1]) * mmap.PAGESIZE

    # the heap gives freed memory again, and so would have to clear it: 377 MB
    before, kept = resident(), collections.deque(maxlen=8)
    for n in range(40):
        kept.append(new_scratches(64, 300, 64 + n))
    assert resident() - before < 30_000_000
    assert not any(scratch.pressure.store.found.any() for scratch in kept[0])


def test_no_two_scratches_share_a_number():
    first, second = new_scratches(2, 10, 5)
    first.pressure.store.found[:] = first.cut.seen[:] = first.cut.store.phases[:] = 1.0
    for array in (second.pressure.store.found, second.cut.seen, second.cut.store.phases):
        assert array.flags.writeable
        assert not array.any()
