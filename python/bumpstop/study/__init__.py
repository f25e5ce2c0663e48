"""Many runs of one case: how its results change with what it is made of."""
