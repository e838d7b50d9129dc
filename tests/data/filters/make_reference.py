#!/usr/bin/env python3
"""Writes iir.json and fir.json beside this file, with SciPy as the independent reference."""
import json
import pathlib

import numpy as np
from scipy import linalg, signal

folder = pathlib.Path(__file__).parent
angles = [0.0, 0.01, 0.05, 0.2, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 3.0, np.pi]
kinds = {"butterworth": "butter", "chebyshev_1": "cheby1", "chebyshev_2": "cheby2", "bessel": "bessel", "elliptic": "ellip"}
passes = {"low": ("lowpass", [0.3]), "high": ("highpass", [0.8]), "band": ("bandpass", [0.3, 0.8]), "stop": ("bandstop", [0.3, 0.8])}


def parts(values):
    return {"re": [float(v) for v in np.real(values)], "im": [float(v) for v in np.imag(values)]}


def bilinear():
    cases = []
    for kind, ftype in kinds.items():
        for pass_, (btype, edges) in passes.items():
            for order in [1, 2, 3, 4, 5, 8]:
                warped = [2 * np.tan(e / 2) for e in edges]
                design = warped if len(warped) == 2 else warped[0]
                if kind == "bessel":
                    z, p, k = signal.bessel(order, design, btype, analog=True, output="zpk", norm="mag")
                else:
                    z, p, k = signal.iirfilter(order, design, 0.5, 50, btype, analog=True, ftype=ftype, output="zpk")
                z, p, k = signal.bilinear_zpk(z, p, k, 1)
                _, h = signal.freqz_zpk(z, p, k, angles)
                cases.append({"kind": kind, "pass": pass_, "order": order, "edges": edges, **parts(h)})
    return cases


def impulse_invariant():
    cases = []
    for kind, btype, edges, order in [("butterworth", "lowpass", [0.3], 2), ("butterworth", "lowpass", [0.5], 5),
                                      ("chebyshev_1", "lowpass", [0.8], 4), ("bessel", "lowpass", [0.3], 4),
                                      ("butterworth", "bandpass", [0.3, 0.5], 2), ("chebyshev_1", "bandpass", [0.8, 1.0], 3)]:
        design = edges if len(edges) == 2 else edges[0]
        if kind == "bessel":
            system = signal.bessel(order, design, btype, analog=True, output="zpk", norm="mag")
        else:
            system = signal.iirfilter(order, design, 0.5, 50, btype, analog=True, ftype=kinds[kind], output="zpk")
        a, b, c, _ = signal.zpk2ss(*system)
        h = [(c @ linalg.expm(a * n) @ b).item() for n in range(60)]
        cases.append({"kind": kind, "pass": "low" if btype == "lowpass" else "band", "order": order, "edges": edges, "impulse": h})
    return cases


def fir():
    cases = []
    for window in ["rectangular", "hann", "hamming", "blackman", "kaiser"]:
        name = {"rectangular": "boxcar", "kaiser": ("kaiser", 6.0)}.get(window, window)
        for pass_, pass_zero, edges in [("low", "lowpass", [0.3]), ("high", "highpass", [0.6]), ("band", "bandpass", [0.3, 0.6]),
                                        ("stop", "bandstop", [0.3, 0.6])]:
            for taps in [21, 24]:
                if taps % 2 == 0 and pass_ in ("high", "stop"):
                    continue
                cut = edges if len(edges) == 2 else edges[0]
                h = signal.firwin(taps, cut, window=name, pass_zero=pass_zero)
                cases.append({"method": "window", "window": window, "pass": pass_, "edges": edges, "taps": [float(v) for v in h]})
    for taps, bands, desired, weights in [
        (31, [0, 0.3, 0.4, 1], [1, 1, 0, 0], [1, 1]),
        (31, [0, 0.3, 0.4, 1], [1, 1, 0, 0], [1, 50]),
        (45, [0, 0.2, 0.3, 0.5, 0.6, 1], [0, 0, 1, 1, 0, 0], [10, 1, 5]),
        (33, [0, 0.9], [0, 0.9], [1]),
    ]:
        h = signal.firls(taps, bands, desired, weight=weights)
        cases.append({"method": "least_squares", "bands": bands, "desired": desired, "weights": weights, "taps": [float(v) for v in h]})
    return cases


(folder / "iir.json").write_text(json.dumps({"angles": angles, "bilinear": bilinear(), "impulse_invariant": impulse_invariant()}, indent=None) + "\n")
(folder / "fir.json").write_text(json.dumps(fir(), indent=None) + "\n")
