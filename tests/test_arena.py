"""The arena of the Singapore AUV Challenge: what stands where, and how its props behave."""

import itertools
import math

import mujoco
import numpy as np
import pytest

from buoyancy_mj import RegularWave, SceneError, Water, add_water, sauvc_arena
from buoyancy_mj.environments.sauvc.layout import COLOURS, draw_layout
