"""What every test needs before numpy or a plotting library is loaded."""

import os

for _threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")  # the tests run on two processes already
os.environ.setdefault("MPLBACKEND", "Agg")  # no window
os.environ.setdefault("PYVISTA_OFF_SCREEN", "true")
