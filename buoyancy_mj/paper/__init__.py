"""The source paper, reproduced.

In: the claims of Mahbub and Shaharear (2025), and the models and scenes that ship.
Out: its figures, tables, and each claim beside what was measured.
May import: scenes, engine, loads, hulls, submersion, meshes, sea, kernels, plotting, errors, files.

Mahbub and Shaharear (2025), Real-Time Buoyancy Estimation for AUV Simulations Using
Convex Hull-Based Submerged Volume Calculation, arXiv 2509.03804.
"""
