"""Anderson's extrapolation of a return map, and the distance of a point from its fixed point."""

from saleg.kernel.jit import compiled, inline
from saleg.kernel.layout import N_VECTOR, VECTOR_PER_SIDE
from saleg.kernel.vector import Z_CHAMBERS, Z_LN_MASS_MOVING, distance

# Points an extrapolation looks back on, and the pivot, over its own square, that ends that.
DEPTH = 4
SINGULAR = 1e-10

# Longest step of an extrapolation that is trusted.
FARTHEST = 0.5


@compiled
def solve(gram, size):
    """Solve a small symmetric system in place by elimination; false if it is nearly singular.

    Row i of `gram` is the i-th equation, its right-hand side in column `size`; on return that
    column holds the solution.
    """
    for i in range(size):
        if not gram[i, i] > SINGULAR * gram[i, size + 1]:
            return False
        for j in range(i + 1, size):
            factor = gram[j, i] / gram[i, i]
            for m in range(i, size + 1):
                gram[j, m] -= factor * gram[i, m]
    for i in range(size - 1, -1, -1):
        for m in range(i + 1, size):
            gram[i, size] -= gram[i, m] * gram[m, size]
        gram[i, size] /= gram[i, i]
    return True


@inline
def inner_product(f, a, b, share):
    """Inner product of ``f - a`` and ``f - share b``.

    Summed side by side: the mirror image of an engine has the same to the last digit, so that no
    search depends on the side.
    """
    middle, left, right = 0.0, 0.0, 0.0
    for n in range(Z_CHAMBERS):
        middle += (f[n] - a[n]) * (f[n] - share * b[n])
    for n in range(Z_CHAMBERS, Z_CHAMBERS + VECTOR_PER_SIDE):
        m = n + VECTOR_PER_SIDE
        left += (f[n] - a[n]) * (f[n] - share * b[n])
        right += (f[m] - a[m]) * (f[m] - share * b[m])
    n = Z_LN_MASS_MOVING
    return middle + (f[n] - a[n]) * (f[n] - share * b[n]) + (left + right)


@compiled
def mix(z, f, z_old, f_old, depth, gram):
    """Weights of the latest images whose residuals cancel best; false if they are undefined."""
    for i in range(depth):
        for j in range(i, depth):
            gram[i, j] = inner_product(f, f_old[i], f_old[j], 1.0)
            gram[j, i] = gram[i, j]
        gram[i, depth + 1] = gram[i, i]  # against which its pivot is judged
        gram[i, depth] = inner_product(f, f_old[i], f, 0.0)
    return solve(gram, depth)


@compiled
def extrapolate(iterates, known):
    """Anderson's step: the mixture of the latest images whose residuals cancel best.

    Writes the next point in place of the image; returns whether it is near enough to trust.
    """
    z, f, z_old, f_old = iterates.point, iterates.residual, iterates.points, iterates.residuals
    target, gram = iterates.image, iterates.gram
    depth = known
    while depth > 0 and not mix(z, f, z_old, f_old, depth, gram):
        depth -= 1
    farthest = 0.0
    for n in range(N_VECTOR):
        image = z[n] + f[n]
        step = 0.0
        for i in range(depth):
            step += gram[i, depth] * (image - z_old[i, n] - f_old[i, n])
        target[n] = image - step
        farthest = max(farthest, abs(step))
    return depth > 0 and farthest <= FARTHEST


@compiled
def slowness(iterates, known):
    """Distance from the fixed point over the residual, at most, between the latest points.

    What decays by a factor m per return is ``1 / (1 - m)`` residuals away from where it will end.
    """
    z, f, z_old, f_old = iterates.point, iterates.residual, iterates.points, iterates.residuals
    slowest = 1.0
    for i in range(known):
        way, change = distance(z, z_old[i]), distance(f, f_old[i])
        if way > slowest * change:
            slowest = way / max(change, 1e-300)
    return slowest


@compiled
def push(z, f, z_old, f_old):
    """Remember a point and its residual as the latest."""
    for i in range(DEPTH - 1, 0, -1):
        for n in range(N_VECTOR):
            z_old[i, n], f_old[i, n] = z_old[i - 1, n], f_old[i - 1, n]
    for n in range(N_VECTOR):
        z_old[0, n], f_old[0, n] = z[n], f[n]
