"""What a response tells: impacts, energies, comparisons. Pure functions of it."""
