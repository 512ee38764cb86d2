"""Published numbers beside what comes out here.

In: published numbers with their sources, and the models that ship.
Out: one row for each quantity, its verdict, and the page that holds them all.
May import: scenes, vehicle, engine, statics, loads, hulls, potential, sea, plotting, errors, files.

`case` defines a case and runs a body; `report` runs all cases and writes the page; the other
modules hold the cases.
"""
