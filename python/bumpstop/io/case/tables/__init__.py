"""The tables of a case file, one file a concept. Each is a pydantic model of what users write."""
