"""Exudyn's generalised alpha method, with the stops as a force that Python tells."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2, SensorNode

from benchmarks.precision.equations import Equations
from benchmarks.precision.problems import INSTANTS, Watched
from tests.reference.problem import Array


class GeneralizedAlpha:
    """A generic second-order object for all modes."""

    def __init__(self, problem: Watched) -> None:
        self._problem = problem
        self._equations = Equations(problem)

    def __call__(self, step: float) -> Array:
        """Run it."""
        equations, duration = self._equations, self._problem.problem.duration
        count = equations.modes
        system: Any = exu.SystemContainer().AddSystem()
        node = system.AddNode(
            NodeGenericODE2(
                referenceCoordinates=np.zeros(count),
                initialCoordinates=equations.start[:count],
                initialCoordinates_t=equations.start[count:],
                numberOfODE2Coordinates=count,
            )
        )

        def force(_system: Any, _time: float, _item: int, q: Any, v: Any) -> Array:
            return equations.push(np.array(q), np.array(v))

        system.AddObject(
            ObjectGenericODE2(
                nodeNumbers=[node],
                massMatrix=np.eye(count),
                stiffnessMatrix=np.diag(equations.omega2),
                dampingMatrix=np.diag(equations.damping),
                forceUserFunction=force,
            )
        )
        kind = exu.OutputVariableType.Coordinates
        sensor = system.AddSensor(
            SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind)
        )
        system.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = round(duration / step)
        settings.timeIntegration.endTime = duration
        settings.timeIntegration.verboseMode = 0
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = duration / INSTANTS
        settings.solutionSettings.solutionInformation = ""
        system.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha)
        stored: Array = system.GetSensorStoredData(sensor)
        found: Array = stored[1 : INSTANTS + 1, 1:] @ self._problem.row
        return found
