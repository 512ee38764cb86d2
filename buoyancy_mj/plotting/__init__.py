"""How charts look, all of them.

In: what a chart shows, and the name of its file.
Out: empty figures in one style, and files of pictures.
May import: files.
"""
