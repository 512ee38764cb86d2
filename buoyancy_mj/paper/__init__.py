"""The source paper, reproduced: its methods run, its figures are drawn, its claims are checked.

Scenes and models that ship in; tables, figures and a page (`docs/paper`) out.
Imports: scenes, engine, loads, hulls, submersion, meshes, sea, kernels, errors.

Mahbub and Shaharear (2025), Real-Time Buoyancy Estimation for AUV Simulations Using Convex
Hull-Based Submerged Volume Calculation, arXiv 2509.03804.
"""
