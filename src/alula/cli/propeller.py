"""`alula propeller FILE`: thrust, power and efficiency of a propeller over the advance ratio."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    ReportOption,
    SeedOption,
    ThreadsOption,
    writable,
)
from alula.cli.propeller_output import result_of, text_of

if TYPE_CHECKING:
    from alula.aircraft.blades import Blades
    from alula.aircraft.load_propeller import PropellerDescription
    from alula.base.messages import Message
    from alula.predict.propeller_curves import PropellerCurves
    from alula.predict.propeller_fit import PropellerFit
    from alula.predict.propeller_test import PropellerTest

_TIP_SPEED = 100.0  # m/s, where no speed of revolution is stated


def propeller(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="Propeller TOML, QPROP's .def, APC's .PE0 or UIUC's geometry."
        ),
    ],
    J: Annotated[
        str | None,
        typer.Option("--J", metavar="J,J,...", help="Advance ratios; default 0 to the windmill."),
    ] = None,
    rpm: Annotated[
        float | None,
        typer.Option(metavar="RPM", help="For Reynolds numbers; default the file's."),
    ] = None,
    test: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE", help="Test of the UIUC database to fit the model to; several times."
        ),
    ] = None,
    fit_below: Annotated[
        float | None,
        typer.Option(metavar="J", help="Fit only test values at smaller advance ratios."),
    ] = None,
    diameter: Annotated[
        float | None, typer.Option(metavar="M", help="m, for geometry that does not state it.")
    ] = None,
    blades: Annotated[
        int | None, typer.Option(metavar="N", help="Their number, likewise; default 2.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the curves there, .png or .svg.")
    ] = None,
    report: ReportOption = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """CT, CP and efficiency of a propeller over J by momentum disk and by blade elements.

    A test in the file or by --test identifies the momentum disk's parameters. Exit 0: done. 1: the
    test does not determine all of them. 2: bad input, or J in reverse flow or the windmill.
    """
    command = Command("propeller", json, seed, threads, quiet)
    with command.run():
        if plot is not None:
            _check_plot(plot)
        writable(report, "report")
        from alula.aircraft.load_propeller import load_propeller
        from alula.cli.condition import source_of

        described = load_propeller(file, diameter, blades)
        work = Work(described, _numbers(J), rpm or described.rpm)
        work.fit_all(test or (), fit_below)
        work.compute()
        command.inputs = [source_of(p) for p in (file, *(test or ()))]
        command.messages = work.messages
        command.status = "ok" if work.identified else "not_identifiable"
        command.result = result_of(work)
        command.say(text_of(work))
        if plot is not None:
            _write(plot, work)
        if report is not None:
            from alula.base.files import write_whole
            from alula.report.propeller_page import propeller_page

            write_whole(
                report,
                propeller_page(
                    work.blades,
                    work.rpm,
                    work.curves,
                    work.fits,
                    work.test,
                    work.fit_below,
                    work.messages,
                ),
            )
        command.written(Picture=plot, Report=report)


@dataclass
class Work:
    """From the description to fits and curves."""

    described: PropellerDescription
    J: list[float] | None
    rpm: float | None
    messages: list[Message] = field(default_factory=list)
    fits: dict[str, PropellerFit] = field(default_factory=dict)
    curves: dict[str, tuple[PropellerCurves, float]] = field(default_factory=dict)
    test: PropellerTest | None = None
    fit_below: float | None = None

    @property
    def blades(self) -> Blades:
        return self.described.blades

    @property
    def identified(self) -> bool:
        return all(fit.identified for fit in self.fits.values())

    def fit_all(self, files: tuple[Path, ...] | list[Path], fit_below: float | None) -> None:
        """Every test of the file and of the options."""
        from alula.aircraft.propeller_files import read_uiuc_test
        from alula.base.messages import refuse
        from alula.base.units import DEG
        from alula.predict.propeller_fit import fit_propeller
        from alula.predict.propeller_test import propeller_test, static_test

        d, given = self.described, {}
        if d.fit.alpha_max_deg is not None:
            given["alpha_max"] = d.fit.alpha_max_deg * DEG
        for key in ("pitch", "c_l_alpha", "c_d_alpha"):
            if getattr(d.fit, key) is not None:
                given[key] = getattr(d.fit, key)
        columns: tuple[list[float], ...] = ([], [], [])
        runs: list[str] = []
        table = d.test
        if table is not None:
            for column, values in zip(columns, (table.J, table.CT, table.CP), strict=True):
                column.extend(values)
            runs += table.run or ["test"] * len(table.J)
        for path in files:
            for column, more in zip(columns, read_uiuc_test(path), strict=True):
                column.extend(more.tolist())
            runs += [path.stem] * (len(columns[0]) - len(runs))
        if runs:
            alone = None if files else table  # stated errors are those of the file's own table
            self.test = propeller_test(
                columns[0], columns[1], columns[2], runs,
                se_CT=None if alone is None else alone.se_CT,
                se_CP=None if alone is None else alone.se_CP, where=self.blades.name,
            )  # fmt: skip
            self.fit_below = d.fit.J_max if fit_below is None else fit_below
            fitted = self.test if self.fit_below is None else self.test.below(self.fit_below)
            if not len(fitted.J):
                raise refuse(
                    "empty_propeller_test",
                    where=self.blades.name,
                    expected=f"test values at J below {self.fit_below:g}",
                    found="none",
                    do="Raise --fit-below.",
                )
            self.fits["test"] = fit_propeller(self.blades, fitted, given)
        s = d.static_test
        if s is not None:
            import numpy as np

            bench = static_test(
                s.thrust, np.pi / 30.0 * np.array(s.rpm), s.voltage, s.current, s.motor_efficiency,
                self.blades.diameter, s.density, s.motor_efficiency_se,
            )  # fmt: skip
            self.fits["static test"] = fit_propeller(self.blades, bench, given)

    def compute(self) -> None:
        """The curves of every model for which there are parameters."""
        from dataclasses import replace

        import numpy as np

        from alula.aircraft.propeller_files import assumed_polar
        from alula.base.messages import note, warn
        from alula.predict.propeller_blade_element import blade_element, blade_element_windmill
        from alula.predict.propeller_momentum import momentum_propeller, windmill_J

        blades = self.blades
        models = {} if blades.momentum is None else {"momentum disk": blades.momentum}
        for name, fit in self.fits.items():
            if fit.parameters is not None:
                models[f"momentum disk, {name}"] = fit.parameters
        if not blades.polars and not models:
            polar = assumed_polar()
            blades = replace(blades, polars=(polar,))
            self.messages.append(
                warn(
                    "assumed_polar",
                    where=blades.name,
                    expected="a polar of the blades' sections, or a test",
                    found="neither",
                    do=f"Taken: {polar.source}. State [blades.polar] or give --test.",
                )
            )
        for label, parameters in models.items():
            last = windmill_J(blades, parameters)
            curve = momentum_propeller(blades, self._at(last), parameters)
            self.curves[label] = (curve, last)
        if blades.polars:
            if self.rpm is None:
                self.rpm = round(_TIP_SPEED / blades.radius * 30.0 / np.pi, -2)
                self.messages.append(
                    note(
                        "assumed_rpm",
                        where=blades.name,
                        expected="a speed of revolution for Reynolds and Mach numbers",
                        found="none",
                        do=f"Taken: {self.rpm:g} rpm, a tip speed of {_TIP_SPEED:g} m/s; --rpm.",
                    )
                )
            last = blade_element_windmill(blades, self.rpm)
            density = self.described.density
            curve = blade_element(blades, self._at(last), self.rpm, density=density)
            self.curves["blade elements"] = (curve, last)

    def _at(self, last: float) -> list[float]:
        """The advance ratios asked for, or evenly spaced ones up to the windmill."""
        import numpy as np

        if self.J is not None:
            return self.J
        return [float(x) for x in np.linspace(0.0, last * (1.0 - 1e-6), 21)]


def _numbers(text: str | None) -> list[float] | None:
    if text is None:
        return None
    try:
        return [float(word) for word in text.split(",") if word.strip()]
    except ValueError:
        from alula.base.messages import refuse

        raise refuse(
            "bad_advance_ratio",
            where="--J",
            expected="numbers with commas between, e.g. 0,0.2,0.4",
            found=f"'{text}'",
            do="Correct it.",
        ) from None


def _check_plot(plot: Path) -> None:
    from alula.base.messages import refuse

    if plot.suffix.lower() not in (".png", ".svg"):
        raise refuse(
            "picture_format",
            where="--plot",
            expected="a name that ends in .png or .svg",
            found=f"'{plot.name}'",
            do="Rename it.",
        )
    writable(plot, "plot")


def _write(path: Path, work: Work) -> None:
    import io

    from alula.base.files import write_whole
    from alula.predict.propeller_plot import plot_propeller

    kind = path.suffix.lower()[1:]
    curves = [(name, curve) for name, (curve, _) in work.curves.items()]
    figure = plot_propeller(work.blades.name, curves, work.test, work.fit_below)
    out = io.BytesIO()
    mark = {"Software": "Alula"} if kind == "png" else {"Creator": "Alula", "Date": None}
    figure.savefig(out, format=kind, dpi=150, metadata=mark)
    write_whole(path, out.getvalue())
