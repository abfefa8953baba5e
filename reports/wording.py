"""How numbers are written on the page."""

import math
import re

from markupsafe import Markup, escape

LENGTHS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9), ("pm", 1e-12))
STRESSES = (("MPa", 1e6), ("kPa", 1e3), ("Pa", 1.0))
ANGLES = (("rad", 1.0), ("mrad", 1e-3), ("µrad", 1e-6), ("nrad", 1e-9))
FORCES = (("kN", 1e3), ("N", 1.0), ("mN", 1e-3), ("µN", 1e-6))
MOMENTS = (("N m", 1.0), ("mN m", 1e-3), ("µN m", 1e-6))
ENERGIES = (("J", 1.0), ("mJ", 1e-3), ("µJ", 1e-6), ("nJ", 1e-9))

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


LAWS = {"coulomb": "Coulomb’s law", "tresca": "Tresca’s law", "capped": "the capped law of friction",
        "power": "the power law of friction"}


def law(result):
    """The law of friction of a result, which leaves out Coulomb's."""
    return LAWS[result.get("friction_law", "coulomb")]


def sci(number):
    """2.1×10⁻⁶; plain 0 for zero; NaN means a number that is null."""
    if math.isnan(number):
        return "not available"
    if number == 0:
        return "0"
    mantissa, exponent = f"{number:.1e}".split("e")
    return f"{mantissa}×10{str(int(exponent)).translate(SUPERSCRIPTS)}".replace("-", "−")


def percent(number, sign="-"):
    """Two significant digits of a ratio, in per cent; with sign="+" positive ones show theirs too."""
    digits = float(f"{100 * number:.2g}")
    return f"{digits:{sign}g}\N{NO-BREAK SPACE}%".replace("-", "−")


def signed_percent(number):
    return percent(number, "+")


def rounded_down(number):
    """Two significant digits of a positive number, downwards: up to where a bound surely holds."""
    if not number > 0:
        return plain(number)
    digits = 1 - math.floor(math.log10(number))  # after the point; before it where negative
    scaled = math.floor(number * 10.0**digits * (1 + 1e-12))
    return f"{scaled / 10.0**digits:.{max(digits, 0)}f}"


def plain(number):
    """Six significant digits."""
    return f"{number:.6g}".replace("-", "−")


def seconds(number):
    """Three digits of a time in seconds."""
    return f"{number:.3g}"


def unit_for(largest, units):
    """The largest unit that is not much above the value."""
    for name, size in units:
        if largest >= 0.5 * size:
            return name, size
    return units[-1]


def quantity(number, units, digits=3):
    name, size = unit_for(abs(number), units) if number else units[0]
    return f"{number / size:.{digits}g} {name}".replace("-", "−")


def typeset(plain_text):
    """A sentence of the program as it is printed, in HTML: powers, roots, numbers and apostrophes."""
    for written, printed in ((r"\b(\w)\^\(1/2\)", r"√\1"), (r"\b(\w)\^\(-1/2\)", r"1/√\1"), ("'", "’")):
        plain_text = re.sub(written, printed, plain_text)
    plain_text = re.sub(r"\^(-?\d+)(?!\d*\.\d)", lambda power: power[1].translate(SUPERSCRIPTS), plain_text)
    plain_text = re.sub(r"\d(\.\d+)?e[-+]\d+", lambda number: sci(float(number[0])), plain_text)
    return Markup(re.sub(r"\^(-?\d+\.\d+)", r"<sup>\1</sup>", str(escape(plain_text))))
