import os
from pathlib import Path

import numba

from buoyancy_mj.kernels import _drop_stale, triangles
from buoyancy_mj.kernels.caches import list_caches


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


def test_compiled_kernels_that_cannot_be_read_go(tmp_path, monkeypatch):
    (tmp_path / "__pycache__").mkdir()
    for name in ("clip.py", "__pycache__/a.nbi"):
        (tmp_path / name).write_text("")
    # a superuser may read whatever is forbidden
    monkeypatch.setattr(os, "access", lambda path, _: path.suffix != ".nbi")
    _drop_stale(tmp_path)
    assert not list((tmp_path / "__pycache__").iterdir())


def test_compiled_kernels_are_known_where_numba_keeps_them(tmp_path, monkeypatch):
    def keeps() -> Path:
        """Where Numba keeps a kernel that it meets now."""
        return Path(numba.njit(cache=True)(triangles.cut.py_func)._cache.cache_path)

    source = Path(triangles.__file__)
    assert keeps() in list_caches(source)
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    assert keeps().parent == tmp_path
    assert keeps() in list_caches(source)
