"""All options of the water, and their forms as text.

In: tables of TOML, keys of the plugin, flags of the command line.
Out: `Settings`, checked, and the texts of the plugin again.
May import: loads, hulls, submersion, sea, values, errors.
"""
