"""on_meshes_test.py PROGRAM SCENES NAME: `check` calls the fields of a finite-element program good, on a coarse mesh. Skipped (77)
if that program is not installed."""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import on_meshes  # noqa: E402

FACES = {"calculix": 12, "getfem": 16}  # across the contact radius


def main(slipstick, scenes, name):
    scene, (folder, program) = Path(scenes) / "paper.toml", next(on_meshes.found(name))
    if on_meshes.said_version(folder, program) is None:
        print(f"LEFT OUT: {name} is not installed; make peers installs it")
        return 77
    with tempfile.TemporaryDirectory(prefix="slipstick-meshes-") as output:
        numbers, _ = on_meshes.solved(folder, program, scene, FACES[name], Path(output))
        assert list(numbers["twist_angle"]) == ["0.5", "0.9"], numbers
        for ratio, twist in numbers["twist_angle"].items():
            result = on_meshes.judged(slipstick, scene, Path(output) / f"{ratio}.vtu", ratio, twist, numbers["check"])
            assert result["verdict"] == "good", (ratio, result["why"])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
