"""The method as the paper writes it, in plain Python: slow, and there to be checked against the equations by eye.

Every faster path in this package is tested against these functions.
"""

import heapq
import math

import numpy as np


def reference_distances(luminance, range_image, valid, source, *, beta=1.0, neighbors=8, wrap=False, step_cost=0.0):
    """Dijkstra's distance from every pixel to one seed, eq. 5 with the steps of eq. 6.

    Parameters
    ----------
    luminance, range_image : (H, W) array
        Y and D, normalized to 0..255.
    valid : (H, W) bool
    source : (row, col) of int
        The seed's pixel.
    beta : float
    neighbors : {4, 8}
    wrap : bool
        Whether column 0 and column W - 1 are neighbors.
    step_cost : float
        Added to every step (times sqrt(2) on a diagonal); the paper has none.

    Returns
    -------
    (H, W) float64
        Infinite where no path leads.
    """
    height, width = valid.shape
    offsets = [(0, 1), (0, -1), (1, 0), (-1, 0)]
    if neighbors == 8:
        offsets += [(1, 1), (1, -1), (-1, 1), (-1, -1)]
    distance = np.full((height, width), math.inf)
    if not valid[source]:
        return distance
    distance[source] = 0.0
    heap = [(0.0, source)]
    while heap:
        r, p = heapq.heappop(heap)
        if r > distance[p]:
            continue
        for down, right in offsets:
            q = (p[0] + down, p[1] + right)
            if wrap:
                q = (q[0], q[1] % width)
            if not (0 <= q[0] < height and 0 <= q[1] < width and valid[q]):
                continue
            dy = abs(float(luminance[q]) - float(luminance[p]))
            dd = float(range_image[q]) - float(range_image[p])
            step = (beta * dd**2 + 1) * dy + step_cost * math.hypot(down, right)  # eq. 6
            if r + step < distance[q]:
                distance[q] = r + step  # eq. 5
                heapq.heappush(heap, (r + step, q))
    return distance


def reference_blend(distances, chrominance, alpha):
    """Blend the seeds' chrominances at every pixel, eq. 1 and 2, over all seeds.

    Parameters
    ----------
    distances : (S, H, W) float
        r_ij; infinite where seed j does not reach pixel i.
    chrominance : (S, 2) float
        c_j.
    alpha : float

    Returns
    -------
    (H, W, C) float64
        c_i; NaN where no seed reaches.
    """
    count, height, width = distances.shape
    blended = np.full((height, width, np.shape(chrominance)[1]), math.nan)
    for row in range(height):
        for col in range(width):
            r = [float(distances[j, row, col]) for j in range(count)]
            least = min(r)
            if math.isinf(least):
                continue
            if least == 0:
                w = [1.0 if r_j == 0 else 0.0 for r_j in r]  # seeds at no distance share the pixel
            else:
                w = [(r_j / least) ** -alpha if math.isfinite(r_j) else 0.0 for r_j in r]  # eq. 2 over r_min^-alpha
            for channel in range(blended.shape[-1]):
                c = [w_j * float(c_j[channel]) for w_j, c_j in zip(w, chrominance, strict=True)]
                blended[row, col, channel] = math.fsum(c) / math.fsum(w)  # eq. 1
    return blended
