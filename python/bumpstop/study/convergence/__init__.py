"""How wrong a case can be: errors of time, basis and mesh, each by refinement."""

from bumpstop.study.convergence.refinement import converge
from bumpstop.study.convergence.result import Convergence, Ladder, Rung, VariantConvergence

__all__ = ["Convergence", "Ladder", "Rung", "VariantConvergence", "converge"]
