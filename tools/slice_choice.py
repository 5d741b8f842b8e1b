"""Which slices of a stack of contours a thinner table keeps.

A slice i that is left out is read back from its kept neighbours a, b as the mesh maker does (shape-based interpolation): with
the signed distance f of each slice's contours in its plane, f = (1 - t) f_a + t f_b, t = (s_i - s_a) / (s_b - s_a). Its error is

    e_i = (area between its own outline and that of f = 0) / (length of its own outline)   [mm],

the mean distance of the two outlines. From the slices that are given on, or from the two at the ends, the slice with the largest
error is kept until none is above the bound; then each added slice that is not needed for that any more is let go again.
"""
import numpy as np

POINTS = 72  # of a contour
CELL = 1.0  # [mm] of the grid in which areas are measured


def outline(coefficients):
    """points of the closed contour sum_k z_k exp(i k t), coefficients {k: z_k}"""
    t = 2 * np.pi * np.arange(POINTS) / POINTS
    return sum(z * np.exp(1j * k * t) for k, z in coefficients.items())


def signed_distance(contours, grid):
    """negative inside; outer contours run counter-clockwise, holes clockwise"""
    nearest, winding = np.full(grid.shape, np.inf), np.zeros(grid.shape, int)
    for contour in contours:
        for p, q in zip(contour, np.roll(contour, -1)):
            edge, to = q - p, grid - p
            along = to.real * edge.real + to.imag * edge.imag
            gap = to - np.clip(along / max(abs(edge) ** 2, 1e-12), 0, 1) * edge
            nearest = np.minimum(nearest, gap.real ** 2 + gap.imag ** 2)
            left = edge.real * to.imag - edge.imag * to.real
            rises, falls = (p.imag <= grid.imag) & (grid.imag < q.imag), (q.imag <= grid.imag) & (grid.imag < p.imag)
            winding += (rises & (left > 0)).astype(int) - (falls & (left < 0)).astype(int)
    return np.where(winding > 0, -1, 1) * np.sqrt(nearest)


class Stack:
    """slices of a bone in rising height: [(height, [contour, ...]), ...], a contour as complex points"""

    def __init__(self, slices):
        points = np.concatenate([contour for _, contours in slices for contour in contours])
        x, y = (np.arange(part.min() - 2, part.max() + 2 + CELL, CELL) for part in (points.real, points.imag))
        grid = x[None, :] + 1j * y[:, None]
        self.heights = [height for height, _ in slices]
        self.fields = [signed_distance(contours, grid) for _, contours in slices]
        self.lengths = [sum(np.abs(np.roll(c, -1) - c).sum() for c in contours) for _, contours in slices]
        self.known = {}

    def error(self, a, i, b):
        """[mm] of slice i read back from slices a and b"""
        if (a, i, b) not in self.known:
            t = (self.heights[i] - self.heights[a]) / (self.heights[b] - self.heights[a])
            shares = [np.clip(0.5 - field / CELL, 0, 1)  # of each cell inside
                      for field in (self.fields[i], (1 - t) * self.fields[a] + t * self.fields[b])]
            self.known[a, i, b] = np.abs(shares[0] - shares[1]).sum() * CELL ** 2 / self.lengths[i]
        return self.known[a, i, b]

    def errors(self, keep):
        """[(error, slice)] of the slices left out"""
        return [(self.error(a, i, b), i) for a, b in zip(keep, keep[1:]) for i in range(a + 1, b)]

    def largest(self, keep):
        return max(self.errors(keep), default=(0.0, None))

    def choice(self, bound, given=None):
        """slices to keep, those given among them, so that none left out is off by more than bound [mm]"""
        given = given or [0, len(self.heights) - 1]
        keep = list(given)
        while self.largest(keep)[0] > bound:
            keep = sorted(keep + [self.largest(keep)[1]])
        for i in sorted(set(keep) - set(given)):
            fewer = [k for k in keep if k != i]
            if self.largest(fewer)[0] <= bound:
                keep = fewer
        return keep
