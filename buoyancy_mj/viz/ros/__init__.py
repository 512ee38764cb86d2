"""Runs as ROS 2 tools open them: messages by their ROS 2 names, in MCAP files and over Foxglove.

In: frames of a run.
Out: an MCAP file, or a WebSocket server on this machine.
May import: viz, scenes, vehicle, engine, hulls, sea, files, errors.
"""
