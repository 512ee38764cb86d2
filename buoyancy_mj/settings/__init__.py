"""Options as text.

In: tables of TOML, keys of the plugin, flags of the command line.
Out: `Settings`, checked, and the same texts again.
May import: loads, hulls, submersion, sea, errors.
"""
