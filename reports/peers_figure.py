"""The verdicts of `check` on fields that other programs computed."""

import numpy as np

import style
from figure_entry import FigureEntry
from results import column, rows, text, value
from wording import sci

QUANTITIES = {"normal_load_error": "normal load", "contact_radius_error": "contact radius",
              "pressure": "pressure", "pressure_cell": "pressure, one cell", "traction_cell": "traction, one cell", "tractions_inside": "tractions, inside",
              "moment_error": "moment", "force": "tangential force",
              "twist": "twist", "tractions": "tractions", "friction": "friction coefficient",
              "friction_bound": "friction bound", "slip_direction": "slip direction", "gap": "gap of Coulomb’s law"}
LOOKS = ({"color": style.GREEN, "marker": "s"}, {"color": style.VERMILION, "marker": "o"},
         {"color": style.BLUE, "marker": "^"})
MIN_SHOWN = 1e-6  # part of the allowed error; smaller values are drawn there


def peers(report, data_dir):
    programs = rows(report, "peers")
    over = [np.abs(column(rows(each, "judged"), "value")) / column(rows(each, "judged"), "allowed") for each in programs]
    figure, axis = style.panels(1, 1, 3.6)
    names = [QUANTITIES.get(text(row, "quantity"), text(row, "quantity")) for row in rows(programs[0], "judged")]
    for program, errors, look in zip(programs, over, LOOKS):
        axis.plot(np.maximum(errors, MIN_SHOWN), np.arange(len(errors)), linestyle="", label=f"{text(program, 'program')}: "
                  f"{text(program, 'verdict')}", **look)
    axis.axvspan(1, axis.get_xlim()[1] * 1e3, color=style.VERMILION, alpha=0.08, linewidth=0)
    axis.axvline(1, color=style.BLACK, linewidth=0.8)
    axis.set(xscale="log", xlim=(0.6 * MIN_SHOWN, max(30.0, 3 * max(map(np.nanmax, over)))), yticks=range(len(names)), yticklabels=names,
             xlabel="error over what the mesh allows   (wrong right of the line →)")
    axis.invert_yaxis()
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], len(programs))
    bad = [text(each, "program") for each in programs if text(each, "verdict") == "bad"]
    right = all(row["holds"] for each in programs for row in each["judged"] if row["quantity"] == "moment_error")
    return FigureEntry(
        (f"{' and '.join(bad)} carries the right moment, yet its twist, tractions and slip directions are wrong."
         if bad and right else f"{len(programs) - len(bad)} of {len(programs)} fields are right within their mesh."),
        "Tractions that other programs wrote for the paper’s sphere at 0.9 of the limit moment, 64 cells across the contact. "
        "The allowed errors are the errors that right fields have on this mesh, which were measured; slip directions are "
        f"in degrees. Values below {sci(MIN_SHOWN)} of it are drawn there.",
        "Errors of each judged quantity over what is allowed, on a log scale, one row a quantity and one marker a program.",
        figure, [(f"{text(each, 'program')}: {words}", sci(abs(found))) for each in programs
                 for words, found in (("twist error", value(each, "twist_error")),
                                      ("traction error, L2", value(each, "traction_error.l2")),
                                      ("gap / energy", value(each, "certificate.gap"))) if found is not None])
