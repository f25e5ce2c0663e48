"""What all tests share."""

from hypothesis import settings

# Examples are not timed: a busy machine must not fail what is right. They are the same each time.
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")
