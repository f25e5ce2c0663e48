"""Cross sections of beams, one file a shape.

Nothing is imported here, so that a run loads the shapes that it has and no others.
"""
