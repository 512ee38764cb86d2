"""The water at work inside MuJoCo, as a callback and as a plugin.

In: a model, a water and its options; then the engine's arrays, pass by pass.
Out: forces in `qfrc_passive` or `xfrc_applied`, added mass in `M`, and `Loads` for whoever asks.
May import: settings, loads, submersion, hulls, sea, kernels, errors, records.
"""
