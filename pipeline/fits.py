"""Second-order polynomials of the optima over the stator radius.

Reads ``optima.csv``, writes ``fits.csv``: coefficients p2, p1, p0 in the units of the column and millimetres of radius, R^2,
residuals, range, and the reason where a fit is refused.
"""

from __future__ import annotations

import sys

from pipeline.stage import Stage, command, results_folder
from study.read import read_study

OUTPUT = "fits.csv"
QUANTITIES = (
    "torque_nominal_Nm_per_m",
    "torque_overload_Nm_per_m",
    "torque_overload_linear_Nm_per_m",
    "back_iron_width_mm",
    "rotor_outer_radius_mm",
    "half_slot_area_mm2",
)
_COLUMNS = "slots,quantity,p2,p1,p0,r_squared,rms_residual,largest_residual,from_mm,to_mm,refused".split(",")


def stage_of(study) -> Stage:
    """The polynomial fits of a study."""
    from pipeline.optima import OUTPUT as OPTIMA

    folder = results_folder(study.study.id)
    return Stage("fits", folder, {}, (folder / OPTIMA,), ("optimisation.polynomial_fits", "pipeline.fits"), (OUTPUT,))


def fit_all(optima) -> dict[tuple[int, str], object]:
    """``PolynomialFit`` of every quantity by (slots, quantity)."""
    from optimisation.polynomial_fits import fit_polynomial

    return {
        (int(slots), quantity): fit_polynomial(
            f"{quantity} ({slots} slots)", rows.stator_outer_radius_mm, rows[quantity]
        )
        for slots, rows in optima.groupby("slots")
        for quantity in QUANTITIES
    }


def read_fits(study) -> dict[tuple[int, str], object]:
    """The fits of a finished stage by (slots, quantity)."""
    import pandas as pd
    from optimisation.polynomial_fits import PolynomialFit

    rows = pd.read_csv(results_folder(study.study.id) / OUTPUT, keep_default_na=True)
    return {
        (int(row.slots), row.quantity): PolynomialFit(
            f"{row.quantity} ({row.slots} slots)",
            (row.p2, row.p1, row.p0),
            (row.from_mm, row.to_mm),
            row.r_squared,
            row.rms_residual,
            row.largest_residual,
            row.refused if isinstance(row.refused, str) else "",
        )
        for row in rows.itertuples()
    }


def _row(slots: int, quantity: str, fit) -> list:
    numbers = (*fit.coefficients, fit.r_squared, fit.rms_residual, fit.largest_residual, *fit.x_range)
    return [slots, quantity, *numbers, fit.refused]


def main(name: str) -> None:
    """Fit the optima of a study and print how well the polynomials describe them."""
    study = read_study(name)

    def work(run):
        import pandas as pd
        from pipeline.optima import OUTPUT as OPTIMA

        fits = fit_all(pd.read_csv(results_folder(study.study.id) / OPTIMA))
        table = pd.DataFrame([_row(*key, fit) for key, fit in fits.items()], columns=_COLUMNS)
        print(table[["slots", "quantity", "r_squared", "rms_residual", "largest_residual"]].to_string(index=False))
        for fit in fits.values():
            if fit.refused:
                print(f"refused: {fit.quantity}: {fit.refused}")
        run.write(OUTPUT, lambda path: table.to_csv(path, index=False))

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
