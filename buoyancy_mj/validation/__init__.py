"""What is published, beside what comes out here: experiments, benchmarks and closed forms, case by case.

`case` says what a case is and how one runs a body; the other modules hold the cases, `report` runs
them all and writes the page.
"""
