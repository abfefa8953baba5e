"""Tests a law against torsion.csv: Tresca's twist of the stick ratio c is arcosh(1/c)/(2 pi)."""
import csv
import math
import sys

ALLOWED = 1e-12  # relative
tested, largest = 0, 0.0
with open("../tables/torsion.csv", newline="") as file:
    rows = [row for row in csv.DictReader(file) if row["case"] == "constant"]
stick = {(row["given"], row["at"]): float(row["value"]) for row in rows if row["quantity"] == "stick_ratio"}
lacks = {(row["given"], row["at"]): float(row["value"]) for row in rows if row["quantity"] == "stick_complement"}
for row in rows:
    if row["quantity"] == "twist":
        load = row["given"], row["at"]
        root = math.sqrt(lacks[load] * (1 + stick[load]))  # of 1 - c^2
        yours = math.asinh(root / stick[load]) / (2 * math.pi)
        largest = max(largest, abs(yours / float(row["value"]) - 1))
        tested += 1
print(f"{tested} twists, largest relative error {largest:.1e}, allowed {ALLOWED:.0e}")
sys.exit(not (tested > 0 and largest <= ALLOWED))
