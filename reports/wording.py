"""How numbers are written on the page."""

import math

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def sci(number):
    """2.1×10⁻⁶; plain 0 for zero; NaN stands for a number that was null."""
    if math.isnan(number):
        return "not available"
    if number == 0:
        return "0"
    mantissa, exponent = f"{number:.1e}".split("e")
    return f"{mantissa}×10{str(int(exponent)).translate(SUPERSCRIPTS)}".replace("-", "−")


def percent(number):
    """Two significant digits of a ratio, in per cent."""
    return f"{100 * number:.2g}\N{NO-BREAK SPACE}%".replace("-", "−")


def plain(number):
    """Six significant digits."""
    return f"{number:.6g}".replace("-", "−")


def seconds(number):
    """Three digits of a time in seconds."""
    return f"{number:.3g}"
