import os
from pathlib import Path

import numba

from buoyancy_mj.kernels import _caches, _drop_stale, clip


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


def test_compiled_kernels_are_known_where_numba_keeps_them(tmp_path, monkeypatch):
    def keeps() -> Path:
        """Where Numba keeps a kernel that it meets now."""
        return Path(numba.njit(cache=True)(clip.cut.py_func)._cache.cache_path)

    source = Path(clip.__file__)
    assert keeps() in _caches(source)
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    assert keeps().parent == tmp_path
    assert keeps() in _caches(source)
