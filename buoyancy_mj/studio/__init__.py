"""MuJoCo's Studio, as a window or in a browser, with a scene in water that changes while it runs.

In: a scene, and what somebody sets and presses in the panel.
Out: the window or the page, and what its panel shows, as plain values.
May import: viz, drawing, scenes, vehicle, inspection, engine, statics, settings, sea, hulls,
errors.
"""
