"""Kinds of values in a case file: what is written, how it is checked, what editors are told."""
