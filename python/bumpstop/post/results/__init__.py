"""Results that a case asks for by name: what to read out of its runs, figures and numbers."""
