"""The source paper, reproduced: its methods run, its figures come out, its claims are checked.

Mahbub and Shaharear (2025), Real-Time Buoyancy Estimation for AUV Simulations Using Convex
Hull-Based Submerged Volume Calculation, arXiv 2509.03804.
"""
