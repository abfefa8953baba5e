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
