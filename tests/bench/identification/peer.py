"""The same work with NumPy and SciPy: reads a command a line on standard input, answers with CPU and wall seconds of one call.

koopmans_levin FILE LINES ORDER   FILE: U and Y as complex doubles, one after the other, the half spectrum of an even number of samples
frisch FILE LINES                 FILE: uu, yy, |yu|^2 as doubles
"""
import sys
import time

import numpy as np
import scipy.linalg
import scipy.optimize


def koopmans_levin(u, y, order, ratio=6.0):
    lines = len(u)
    samples = 2 * (lines - 1)
    z = np.exp(-2j * np.pi * np.arange(lines) / samples)
    powers = z[:, None] ** np.arange(order, -1, -1)
    phi = np.hstack([y[:, None] * powers, u[:, None] * powers, powers[:, 1:]])
    weight = np.full(lines, 2.0)
    weight[[0, -1]] = 1.0
    phi *= np.sqrt(weight / samples)[:, None]
    sigma = (phi.conj().T @ phi).real
    noise = np.concatenate([np.full(order + 1, ratio), np.ones(order + 1), np.zeros(order)])
    largest = scipy.linalg.eigh(np.diag(noise), sigma, eigvals_only=True, subset_by_index=[len(noise) - 1] * 2)
    return 1.0 / largest[0]


def frisch(a, b, c):
    scale_a, scale_b = a.mean(), b.mean()
    a, b, c = a / scale_a, b / scale_b, c / (scale_a * scale_b)
    cost = lambda x: np.sum((a - x[0]) * (b - x[1]) - c)
    slope = lambda x: np.array([-np.sum(b - x[1]), -np.sum(a - x[0])])
    feasible = {
        "type": "ineq",
        "fun": lambda x: np.concatenate([(a - x[0]) * (b - x[1]) - c, a - x[0], b - x[1]]),
        "jac": lambda x: np.stack([np.concatenate([-(b - x[1]), -np.ones_like(a), 0 * a]),
                                   np.concatenate([-(a - x[0]), 0 * a, -np.ones_like(a)])], axis=1),
    }
    found = scipy.optimize.minimize(cost, [0.0, 0.0], jac=slope, constraints=[feasible], bounds=[(0, None)] * 2,
                                    method="SLSQP", options={"maxiter": 200, "ftol": 1e-6})
    return found.fun * scale_a * scale_b


def main():
    for line in sys.stdin:
        name, file, lines, *rest = line.split()
        if name == "koopmans_levin":
            data = np.fromfile(file, dtype=complex).reshape(2, int(lines))
            call = lambda: koopmans_levin(data[0], data[1], int(rest[0]))
        else:
            data = np.fromfile(file).reshape(3, int(lines))
            call = lambda: frisch(*data)
        cpu, wall = time.process_time(), time.perf_counter()
        value = call()
        print(time.process_time() - cpu, time.perf_counter() - wall, repr(float(value)), flush=True)


main()
