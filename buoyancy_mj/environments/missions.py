"""Missions by the names that scenes give them: each is a task with its referee."""

from collections.abc import Mapping

from buoyancy_mj.environments.sauvc.arena import TASKS

MISSIONS: Mapping[str, str] = {f"sauvc_{task}": task for task in TASKS}
"""Tasks of the Singapore AUV Challenge, by the names of their missions."""
