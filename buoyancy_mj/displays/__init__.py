"""How values look in a notebook.

In: names and values, curves.
Out: a table of HTML, a chart of SVG, both in the notebook's own colours and small.
May import: nothing of this package.
"""
