"""Published experiments, benchmarks and closed forms beside what this package computes.

Published numbers, models that ship and small bodies in; rows that hold or fail, and a page, out.
Imports: scenes, engine, statics, loads, hulls, sea, errors.

`case` says what a case is, `runs` moves a body, `signals` reads its motion; `report` runs all
cases and writes the page. Each other module holds cases of one vehicle or one kind.
"""
