"""Reads a data.h5 with h5py alone and compares it with what recording_fixture.hpp gives. Prints one line: ok, or what is wrong."""
import sys

import h5py
import numpy as np

samples, records = int(sys.argv[2]), int(sys.argv[3])
swmr = len(sys.argv) > 4 and sys.argv[4] == "swmr"
n = np.arange(samples)

with h5py.File(sys.argv[1], "r", libver="latest", swmr=swmr) as f:
    real = f["streams/source.real"]
    at = real.attrs
    if swmr:
        n = np.arange(real.shape[0])
        assert len(n) >= samples, f"{len(n)} samples, at least {samples} expected"
    assert real.shape == (len(n), 2) and real.dtype == np.float64, real
    assert at["sample_rate"] == 1000.0 and at["clock"] == "bench" and at["first_position"] == 0
    assert list(at["channel_names"]) == ["voltage", "current"] and list(at["channel_units"]) == ["V", "A"]
    assert np.array_equal(real[:, 0], 0.1 * n) and np.array_equal(real[:, 1], -1.0 * n)

    index, raw = f["records/source.model/index"][:], f["records/source.model/bytes"]
    assert len(index) >= records, f"{len(index)} records, at least {records} expected"
    for k in range(records):
        offset, size = int(index["offset"][k]), int(index["size"][k])
        assert index["sequence"][k] == k and bytes(raw[offset:offset + 4]) == b"BFR1" and offset + size <= len(raw)

    if not swmr:
        z = f["streams/source.complex"]
        assert z.dtype == np.complex128 and z.attrs["unit"] == "rad/A" and z[3, 0] == 3 - 1.5j
        group = f["records/source.model"]
        assert group.attrs["records"] == records
        decoded = [k for k in group if k not in ("bytes", "index")]
        assert len(decoded) == group.attrs["decoded"] == min(records, 1000), len(decoded)
        assert ("note" in group.attrs) == (records > 1000)
        last = group[str(records - 1)]
        assert last.attrs["record_type"] == "model" and last.attrs["number"] == records - 1
        assert last.attrs["record_time"] == 0.001 * (records - 1)
        assert np.array_equal(last["parameters"], records - 1 + np.array([0, 0.25, 0.5])) and last["parameters"].attrs["unit"] == "1"
        every = f["records/source.trace/0"]
        assert every.attrs["accepted"] == np.True_ and every.attrs["accepted"].dtype == bool
        assert list(every.attrs["names"]) == ["R1", "µ"] and list(every.attrs["orders"]) == [1, 2] and len(every.attrs["empty"]) == 0
        assert every["response"].shape == (2, 1, 1) and every["response"][1, 0, 0] == 2 - 1j
        assert every["mask"].dtype == np.uint8 and every["index"].dtype == np.int64 and every["scalar"][()] == 2.5
        assert every["none"].shape == (0, 4)
print("ok")
