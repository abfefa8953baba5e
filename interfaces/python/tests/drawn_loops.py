"""drawn_loops.py [--count N] [--seed S] [--keep FOLDER]: draws loops of the paper's sphere, N right and N wrong,
and counts what slipstick check says of them. Laws are written here a second time (numpy; Lubkin's by quadrature), nothing of the
program's. Fails where a right loop is called bad, where more than 1 in 20 wrong ones are called good or by a wrong name, or where
more than 1 in 4 have no name: two laws explain them, as noisy or small loops, or none does.
A wrong loop counts as good with reason where it is no farther from the exact one than its noise, or its slip is below that;
another name counts as right where its law with its parameters is no farther from the loop than that."""

import argparse
import math
import sys
from pathlib import Path

import loop_requests
import numpy as np

FRICTION, LOAD, RADIUS, YOUNG, POISSON = 0.1, 1000.0, 0.018, 210e9, 0.3
SHEAR = YOUNG / (2 * (1 + POISSON)) / 2
CONTACT = (3 * LOAD * RADIUS * (1 - POISSON**2) * 2 / (4 * YOUNG))**(1 / 3)
ROTATION, LIMIT = FRICTION * LOAD / (SHEAR * CONTACT**2), 3 * math.pi / 16 * FRICTION * LOAD * CONTACT
STIFFNESS = 16 / 3 / (3 * math.pi / 16)


def elliptic(c):
    """K and E of modulus sqrt(1 - c^2), by arithmetic-geometric means."""
    a, b, lost, power = np.ones_like(c), c.copy(), 0.5 * (1 - c * c), 1.0
    for _ in range(12):
        a, b, gap = (a + b) / 2, np.sqrt(a * b), (a - b) / 2
        lost = lost + power * gap * gap
        power *= 2
    k = np.pi / (2 * a)
    return k, k * (1 - lost)


def first_loading(weight, limit, points=3000):
    """t and M/M_lim over 1 - c: dt = (3/(4 pi)) w dx and dM = (8/3) c^3 w dx of a pressure's weight w = -H'."""
    x = np.concatenate([np.geomspace(1e-9, 0.02, points), np.linspace(0.02, 1 - 1e-5, 4 * points)[1:]])
    nodes, weights = np.polynomial.legendre.leggauss(5)
    ends = np.concatenate([[0.0], x])
    half = np.diff(ends)[:, None] / 2
    c = 1 - (ends[:-1, None] + half * (1 + nodes))
    w = weight(c)
    return (np.concatenate([[0.0], np.cumsum((half * weights * w).sum(1))]),
            np.concatenate([[0.0], np.cumsum((half * weights * c**3 * w).sum(1))]) * limit)


def interpolated(t, m):
    """Odd; what slip takes off, over t^2, is interpolated, so that small moments keep their digits."""
    lost = np.concatenate([[0], (STIFFNESS * t[1:] - m[1:]) / t[1:]**2])
    use = t > 1e-5 * t[-1]
    def law(at):
        size = np.minimum(np.abs(at), t[-1])
        return np.copysign(STIFFNESS * size - size**2 * np.interp(size, t[use], lost[use]), at)
    return law


# H(c) = 2 G phi/mu; t = G a^2 phi/(mu W) with W = (2 pi/3) p0 a^2 of Hertz, pi p0 a^2 of the cone's mean pressure.
HERTZ = first_loading(lambda c: 3 / (4 * np.pi) * elliptic(c)[1] / c, 16 / 3 / (3 * np.pi / 16))
CONE = first_loading(lambda c: 1 / (2 * np.pi) * elliptic(c)[0] / c, 16 / 3 / (3 * np.pi / 16))
exact = interpolated(*HERTZ)
cone = interpolated(*CONE)


def equation_7(t):
    moments = np.linspace(0, 3 * math.pi / 16, 20001)
    root = np.sqrt(np.maximum(0, 1 - 1.5 * moments))
    size = np.interp(np.abs(t), (1 - root) * (3 - root) / 8, moments / moments[-1])
    return np.copysign(size, t)


def exponential(t):
    return np.copysign(-np.expm1(-STIFFNESS * np.abs(t)), t)


def spring(t):
    return np.clip(STIFFNESS * t, -1, 1)


def line(t):
    return STIFFNESS * np.asarray(t)


def scaled(law, limit=1.0, stiffness=1.0):
    return lambda t: limit * law(np.asarray(t) * stiffness / limit)


def masing(t, law, before=()):
    """Masing's rule by a stack of the open reversals (twist, moment)."""
    stack, out, direction = list(before), [], 0.0
    for last, now in zip(np.concatenate([[before[-1][0] if before else 0.0], t[:-1]]), t):
        sign = now - last
        if out and sign * direction < 0:
            stack.append((last, out[-1]))
        if sign:
            direction = sign
        while len(stack) >= 2 and direction * (now - stack[-2][0]) >= 0:
            del stack[-2:]
        if len(stack) == 1 and abs(now) >= abs(stack[0][0]) and (now - stack[0][0]) * direction > 0 and now * stack[0][0] <= 0:
            stack.clear()
        out.append(stack[-1][1] + 2 * float(law((now - stack[-1][0]) / 2)) if stack else float(law(now)))
    return np.array(out)


def without_masing(t, law):
    """Branches from each reversal along first loading, not enlarged."""
    out, start, direction = [], None, 0.0
    for last, now in zip(np.concatenate([[0.0], t[:-1]]), t):
        if out and (now - last) * direction < 0:
            start = (last, out[-1])
        direction = (now - last) or direction
        out.append(float(law(now)) if start is None else start[1] + float(law(now - start[0])))
    return np.array(out)


def isotropic(t, law, parts=8):
    """Elastic within the largest moment so far, on along first loading beyond it."""
    out, m, top, at = [], 0.0, 0.0, 0.0
    for step in np.diff(np.concatenate([[0.0], t])):
        m += STIFFNESS * step
        if abs(m) > top:
            at += (abs(m) - top) / STIFFNESS
            top = float(law(at))
            m = math.copysign(top, m)
        out.append(m)
    return np.array(out)


def by_moment(t, slope, parts=20):
    """dm/dt = STIFFNESS slope(m in the direction of motion), by midpoints."""
    out, m = [], 0.0
    for change in np.diff(np.concatenate([[0.0], t])):
        sign, step = math.copysign(1, change), STIFFNESS * change / parts
        for _ in range(parts):
            m += step * slope(sign * (m + 0.5 * step * slope(sign * m)))
        out.append(m)
    return np.array(out)


class Drawer:
    def __init__(self, seed):
        self.draw = np.random.default_rng(seed)

    def pick(self, *options):
        return options[self.draw.integers(len(options))]

    def drive(self, amplitude, cycles=None):
        """Time and twist: from rest to an amplitude, to its negative and back, in two shapes and several rows a branch."""
        rows = int(self.pick(40, 80, 150, 300))
        cycles = cycles or int(self.pick(1, 2, 3))
        ends = np.concatenate([[0.0], amplitude * np.tile([1.0, -1.0], cycles), [amplitude]]) * self.pick(1, 1, -1)
        part = np.arange(rows) / rows
        if self.draw.random() < 0.5:
            part = (1 - np.cos(np.pi * part)) / 2
        t = np.concatenate([one + (other - one) * part for one, other in zip(ends, ends[1:])] + [ends[-1:]])
        return np.arange(len(t)) / rows, t, rows

    def amplitude(self, low, high):
        """The twist at which the moment has a share of the limit between these."""
        share = self.pick(math.exp(self.draw.uniform(math.log(low), math.log(high))), self.draw.uniform(max(low, 0.1), high))
        return float(np.interp(share, HERTZ[1], HERTZ[0])) if share > 1e-6 else share / STIFFNESS

    def right(self):
        amplitude = self.amplitude(1e-5, 0.99)
        time, t, rows = self.drive(amplitude)
        m = masing(t, exact)
        kind = self.pick("whole", "whole", "reversal", "part", "loading", "minor")
        if kind == "reversal":
            time, t, m = time[rows:], t[rows:], m[rows:]
        elif kind == "part":
            first = int(self.draw.integers(1, 2 * rows))
            last = min(len(t), first + int(self.draw.integers(rows, 3 * rows)))
            time, t, m = time[first:last], t[first:last], m[first:last]
        elif kind == "loading":
            last = max(25, rows)
            time, t, m = time[:last], t[:last], m[:last]
        elif kind == "minor":
            ends = np.concatenate([[0.0], amplitude * self.draw.uniform(-1, 1, int(self.draw.integers(4, 8)))])
            ends[1] = amplitude
            for k in range(2, len(ends)):  # a reversal turns back by a tenth of the range at least
                way = -1 if k % 2 == 0 else 1
                ends[k] = ends[k - 1] + way * max(0.2 * amplitude, min(abs(ends[k] - ends[k - 1]), 2 * amplitude))
            t = np.concatenate([one + (other - one) * np.arange(rows) / rows for one, other in zip(ends, ends[1:])])
            time, m = np.arange(len(t)) / rows, masing(t, exact)
        if kind in ("whole", "reversal", "part") and self.draw.random() < 0.4:  # offsets, or zeroed where it starts
            zeroed = self.draw.random() < 0.5
            t = t - (t[0] if zeroed else np.ptp(t) * self.draw.normal())
            m = m - (m[0] if zeroed else np.ptp(m) * self.draw.normal())
            kind += " zeroed" if zeroed else " offset"
        noise = self.pick(0.0, 1e-5, 1e-3, 3e-3, 1e-2)
        both = self.pick(0.0, 1.0)
        return kind, amplitude, noise, self.rows(time, t, m, noise, both)

    def rows(self, time, t, m, noise, both=0.0):
        half = 0.5 * np.ptp(m) if m.min() < 0 < m.max() else np.ptp(m)
        size = 0.5 * np.ptp(t) if t.min() < 0 < t.max() else np.ptp(t)
        m = m + noise * half * self.draw.normal(size=len(m))
        t = t + both * noise * size * self.draw.normal(size=len(t))
        return np.column_stack([time, m * LIMIT, t * ROTATION])

    def factor(self):
        return float(self.pick(self.draw.uniform(0.4, 0.85), self.draw.uniform(1.18, 2.5)))

    def wrong(self):
        """(names that are right, clean moments, noise, rows)."""
        name = self.pick("stiffness", "limit", "factor", "limit_and_stiffness", "other_profile", "exponential", "spring_and_cap",
                         "rigid", "elastic", "not_enlarged", "unloads_without_slip", "regularised", "viscous", "equation_7", "unit", "hyperbola", "dahl", "bouc_wen",
                         "bilinear", "delayed", "stribeck")
        # Eq. (7) has the exact law's first two terms: below 0.45 of the limit it is within the 1 % that a good loop may be off.
        amplitude = self.amplitude(0.45 if name == "equation_7" else 1e-3, 0.99)
        time, t, rows = self.drive(amplitude)
        rate = np.gradient(t, time)
        top = np.abs(rate).max()
        f, g = self.factor(), self.factor()
        kinds = {
            "stiffness": lambda: masing(t, scaled(exact, stiffness=f)),
            "limit": lambda: masing(t, scaled(exact, limit=f)),
            "factor": lambda: f * masing(t, exact),
            "limit_and_stiffness": lambda: masing(t, scaled(exact, f, g)),
            "other_profile": lambda: masing(t, self.pick(cone, scaled(cone, 9 / 8))),
            "exponential": lambda: masing(t, self.pick(exponential, scaled(exponential, f))),
            "spring_and_cap": lambda: masing(t, self.pick(spring, scaled(spring, 1.13, self.pick(1, f)))),
            "rigid": lambda: masing(t, scaled(spring, 1, 1e5)),
            "elastic": lambda: self.pick(line, scaled(line, 1, f), exact)(t),
            "not_enlarged": lambda: without_masing(t, exact),
            "unloads_without_slip": lambda: isotropic(t, exact),
            "regularised": lambda: self.pick(1, f) * np.tanh(rate / (self.draw.uniform(0.05, 0.8) * top)),
            "viscous": lambda: masing(t, exact) + self.draw.uniform(0.05, 0.4) * np.abs(masing(t, exact)).max() * rate / top,
            "equation_7": lambda: masing(t, equation_7),
            "unit": lambda: masing(t, exact),
            "hyperbola": lambda: masing(t, scaled(lambda x: STIFFNESS * x / (1 + STIFFNESS * np.abs(x)), self.pick(1, f))),
            "dahl": lambda: by_moment(t, self.pick(lambda m: 1 - m, lambda m: (1 - m)**2)),
            "bouc_wen": lambda: by_moment(t, lambda m: 1 - max(m, 0)**2),
            "bilinear": lambda: masing(t, scaled(spring, 0.5, 0.8)) + 0.2 * line(t),
            "delayed": lambda: np.interp(time - self.draw.uniform(0.03, 0.1), time, masing(t, exact)),
            "stribeck": lambda: np.tanh(rate / (0.06 * top)) * (1 + 0.6 * np.exp(-(rate / (0.25 * top))**2)),
        }
        m = np.asarray(kinds[name]())
        noise = self.pick(0.0, 1e-3, 1e-2)
        if name == "viscous" and self.draw.random() < 0.3:
            m = line(t) + 0.2 * np.abs(line(t)).max() * rate / top
        start = rows if self.draw.random() < 0.25 else 0
        time, t, m = time[start:], t[start:], m[start:]
        table = self.rows(time, t, m, noise)
        conventions = None
        if name == "unit":
            load, motion, sign = self.pick(1, 1e-3, 1e-6, 1e3), self.pick(1, math.pi / 180, 1e-3, 1e-6), self.pick(1, -1)
            table[:, 1] /= load * sign
            table[:, 2] /= motion
            conventions = (load, motion, sign)
        return name, amplitude, noise, table, time, t, m, start, conventions

    @staticmethod
    def right_moments(t, start):
        """The exact law's over the same twists, on from rest or from the reversal that the record starts at."""
        before = [(t[0], float(exact(t[0])))] if start else []
        return masing(t, exact, before)


def law_of(name, p, time, t, start, why):
    """Moments of a law that the program named, with its parameters; none: not written here."""
    rate = np.gradient(t, time)
    top = np.abs(rate).max()
    def follow(law):
        return masing(t, law, [(t[0], float(law(t[0])))] if start else [])
    both = {0: (1, 1), 2: tuple(p) if len(p) == 2 else (1, 1)}.get(len(p))
    options = [both] if both else [(p[0], 1), (1, p[0])]
    curves = {"exponential": exponential, "spring_and_cap": spring, "rigid": scaled(spring, 1, 1e5), "other_profile": scaled(cone, 8 / 9 * 9 / 8)}
    if name == "stiffness":
        return [follow(scaled(exact, 1, p[0]))]
    if name == "limit":
        return [follow(scaled(exact, p[0], 1))]
    if name == "factor":
        return [p[0] * follow(exact)]
    if name == "limit_and_stiffness":
        return [follow(scaled(exact, *p))]
    if name == "elastic":
        return [scaled(law, *o)(t) for law in (line, exact) for o in options]
    if name == "viscous":
        return [law + p[0] * np.abs(law).max() * rate / top for law in (follow(exact), line(t))]
    if name == "regularised":
        return [p[0] * shape(rate / (p[1] * top)) for shape in (np.tanh, lambda r: np.clip(r, -1, 1))]
    if name == "equation_7":
        return [follow(equation_7)]
    if name in curves:
        return [follow(scaled(curves[name], *o)) for o in options]
    return []


def same_rate(time, t):
    rate = np.sort(np.abs(np.gradient(t, time)))
    return rate[len(rate) // 10] > 0.999 * rate[-1]


def off(one, other, part=1.0):
    """Root mean square of the distance, without the offset, over the larger half range; of the nearest part of the rows."""
    gap = one - other
    gap = np.sort(np.abs(gap - gap.mean()))[:int(part * len(gap))]
    return float(np.sqrt(np.mean(gap**2)) / (0.5 * np.ptp(other)))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--count", type=int, default=200)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--keep", type=Path)
    options = arguments.parse_args()
    drawer = Drawer(options.seed)
    columns = ("time", "moment", "rotation")

    def check(table, strict=False):
        return loop_requests.judged(dict(zip(columns, table.T.tolist())), strict=strict)

    def keep(table, name):
        if options.keep:
            options.keep.mkdir(exist_ok=True)
            loop_requests.write_table(options.keep / f"{name}.csv", columns, table.tolist())

    bad = good = fair = named_wrong = unnamed = judged = 0
    for k in range(options.count):
        kind, amplitude, noise, table = drawer.right()
        result = check(table, strict=bool(k % 2))
        if result["verdict"] == "bad":
            bad += 1
            print(f"right {k}: {kind}, t {amplitude:.2g}, noise {noise:g}: bad: {result['why']}")
            keep(table, f"right-{k}")
    for k in range(options.count):
        name, amplitude, noise, table, time, t, m, start, conventions = drawer.wrong()
        result = check(table)
        law, why = result["loads"][0].get("law"), result["why"]
        shown = f"wrong {k}: {name}, t {amplitude:.2g}, noise {noise:g}, start {start}:"
        if name == "unit":
            judged += 1
            load, motion, sign = conventions
            notes = {1e-3: "N mm", 1e-6: "mN mm", 1e3: "kN m"}, {1e-3: "mrad", 1e-6: "urad", math.pi / 180: "degrees"}
            wanted = [notes[0].get(load, ""), notes[1].get(motion, "")] + (["other body"] if sign < 0 else [])
            said = " ".join(result["conventions"]) + why
            if conventions == (1, 1, 1):
                judged -= 1
                named_wrong += result["verdict"] != "good"
            elif off(line(t), m) <= noise / 3 and wanted[2:] == [word for word in wanted[2:] if word in said] and \
                    (result["verdict"] == "good" or "as in another unit" in said):
                fair += 1  # a line has only a stiffness, which does not say which unit differs
                judged -= 1
            elif not all(word in said for word in wanted):
                named_wrong += 1
                print(shown, conventions, result["verdict"], result["conventions"], why)
                keep(table, f"wrong-{k}")
            continue
        away = off(drawer.right_moments(t, start), m)
        if result["verdict"] == "good":
            if away <= noise:
                fair += 1
                continue
            judged += 1
            good += 1
            print(shown, f"{away:.2g} off, good: {why}")
            keep(table, f"wrong-{k}")
            continue
        judged += 1
        # At one rate, to and fro, moments that follow its sign are rigid and regularised.
        if law == name or ({law, name} == {"rigid", "regularised"} and same_rate(time, t)):
            continue
        if law is None:
            unnamed += 1
            continue
        tried = [entry for entry in result["loads"][0]["tried"] if entry["law"] == law]
        same = any(off(other, m, 0.98) <= max(noise / 3, 1e-6)
                   for entry in tried for other in law_of(law, entry["parameters"], time, t, start, why))
        if not same:
            named_wrong += 1
            print(shown, f"{away:.2g} off, named {law}: {why}")
            keep(table, f"wrong-{k}")
    print(f"{options.count} right: {bad} bad; {judged} wrong and not within their noise ({fair} within it): {good} good, "
          f"{named_wrong} with a wrong cause, {unnamed} without a name")
    sys.exit(1 if bad or 20 * good > judged or 20 * named_wrong > judged or 4 * unnamed > judged else 0)


if __name__ == "__main__":
    main()
