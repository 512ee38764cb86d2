import os

from buoyancy_mj.kernels import _drop_stale


def test_compiled_kernels_older_than_any_source_go(tmp_path):
    cache = tmp_path / "__pycache__"
    cache.mkdir()
    for name, time in (
        ("waves.py", 200),
        ("clip.py", 100),
        ("__pycache__/a.nbi", 150),
        ("__pycache__/b.1.nbc", 250),
    ):
        (tmp_path / name).write_text("")
        os.utime(tmp_path / name, (time, time))
    _drop_stale(tmp_path)
    assert {path.name for path in cache.iterdir()} == {"b.1.nbc"}
