"""The benchmarks of `scripts/bench.py`: each module measures, and describes what it measured."""
