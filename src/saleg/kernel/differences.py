"""Derivatives of the return maps of many engines, by central differences."""

from typing import Any, NamedTuple

from saleg.kernel.jit import cached, compiled
from saleg.kernel.layout import END_OF_TIME, N_VECTOR
from saleg.kernel.orbit import image_of, take_state


class Differences(NamedTuple):
    """Engines at dead centres where their return maps are differentiated; a row per engine.

    Attributes
    ----------
    engine : ndarray of ENGINE_RECORD, shape (n,)
    chambers : ndarray of CHAMBER_RECORD, shape (2 n,)
    y : ndarray, shape (n, N_ALL)
        State, of which the vector is replaced.
    longest : ndarray, shape (n,)
        Longest time to the next return [s].
    points : ndarray, shape (n, N_VECTOR)
        The vectors.
    moved : ndarray of bool, shape (n, N_VECTOR)
        Entries by which to differentiate.
    by : float
        Difference on either side.
    matrices : ndarray, shape (n, N_VECTOR, N_VECTOR)
        The derivatives, zero at first.
    codes : ndarray of int, shape (n,)
        Why the integrator came back; without END_OF_TIME there is no derivative.
    """

    engine: Any
    chambers: Any
    y: Any
    longest: Any
    points: Any
    moved: Any
    by: float
    matrices: Any
    codes: Any


@compiled
def image_beside(differences, row, mapping, entry, change, iterates):
    """Image of the vector of an engine with one entry changed; why the integrator came back."""
    take_state(differences, row, mapping.integration)
    for n in range(N_VECTOR):
        iterates.point[n] = differences.points[row, n]
    iterates.point[entry] += change
    return image_of(mapping, iterates)


@compiled
def differentiate_by(entry, differences, row, mapping, iterates):
    """Derivative by one entry of the vector; why the integrator came back.

    An entry on which nothing depends, to the last bit, is seen by its first image.
    """
    middle, ahead, image = iterates.residual, iterates.points[0], iterates.image
    code = image_beside(differences, row, mapping, entry, differences.by, iterates)
    same = True
    for m in range(N_VECTOR):
        ahead[m] = image[m]
        same = same and image[m] == middle[m]
    if same or code != END_OF_TIME:
        return code
    code = image_beside(differences, row, mapping, entry, -differences.by, iterates)
    for m in range(N_VECTOR):
        differences.matrices[row, m, entry] = (ahead[m] - image[m]) / (2.0 * differences.by)
    return code


@compiled
def differentiate(differences, row, mapping, iterates):
    """Derivative of the return map of an engine; why the integrator came back."""
    code = image_beside(differences, row, mapping, 0, 0.0, iterates)
    for m in range(N_VECTOR):
        iterates.residual[m] = iterates.image[m]
    for entry in range(N_VECTOR):
        if code == END_OF_TIME and differences.moved[row, entry]:
            code = differentiate_by(entry, differences, row, mapping, iterates)
    return code


@cached
def find_jacobian(mapping, iterates, differences):
    """Entry point: differentiate the return map of one engine."""
    differences.codes[0] = differentiate(differences, 0, mapping, iterates)
    return differences.codes[0]


@cached
def find_jacobians(mapping, iterates, laws, differences):
    """Entry point: differentiate the return maps of engines whose laws have these numbers."""
    for row in range(differences.codes.shape[0]):
        for n in range(laws.shape[1]):
            mapping.integration.laws[n] = laws[row, n]
        differences.codes[row] = differentiate(differences, row, mapping, iterates)
    return 0
