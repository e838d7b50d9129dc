"""Vector fitting by scikit-rf: reads a command a line on standard input,
  ORDER TUNING PORTS FILE
with TUNING from 1 on and FILE with rows of Hz and PORTS x PORTS pairs of real and imaginary part, column by column. Answers
"CPU RMS UNSTABLE TUNINGS": seconds of CPU of one call, rms of the error over lines and entries, unstable poles (-1: it failed), how
many tunings there are. A first line names scikit-rf and the BLAS.
"""
import contextlib
import itertools
import logging
import re
import sys
import time
import warnings

import numpy.typing  # scikit-rf takes it for loaded
import numpy as np
import scipy.linalg

with contextlib.redirect_stdout(sys.stderr):  # it tells which packages it lacks
    import skrf
    from skrf.vectorFitting import VectorFitting

TUNINGS = list(itertools.product(["lin", "log"], [0, 2]))  # spacing of the first poles, how many are real (one more of an odd order)


def blas():
    scipy.linalg.svd(np.eye(2))
    with open("/proc/self/maps") as maps:
        names = sorted(set(re.findall(r"/(lib\w*blas\S*\.so\S*)", maps.read())))
    return ", ".join(names)


def fit(order, spacing, real, network):
    fitting = VectorFitting(network)
    real += order % 2
    cpu = time.process_time()
    fitting.vector_fit(n_poles_real=real, n_poles_cmplx=(order - real) // 2, init_pole_spacing=spacing,
                       fit_constant=True, fit_proportional=False)
    cpu = time.process_time() - cpu
    ports = network.nports
    error = [fitting.get_model_response(i, j, network.f) - network.s[:, i, j] for i in range(ports) for j in range(ports)]
    rms = np.sqrt(np.mean(np.abs(np.array(error)) ** 2))
    return cpu, rms, int(np.sum(np.real(fitting.poles) > 0))


def main():
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    print(f"scikit-rf {skrf.__version__}, NumPy {np.__version__}, BLAS: {blas()}", flush=True)
    for line in sys.stdin:
        order, tuning, ports, file = line.split()
        data = np.loadtxt(file)
        n = int(ports)
        values = (data[:, 1::2] + 1j * data[:, 2::2]).reshape(-1, n, n).transpose(0, 2, 1)
        network = skrf.Network(f=data[:, 0], f_unit="hz", s=values)
        try:
            answer = fit(int(order), *TUNINGS[int(tuning) - 1], network)
        except Exception:
            answer = 0.0, float("inf"), -1
        print(*answer, len(TUNINGS), flush=True)


main()
