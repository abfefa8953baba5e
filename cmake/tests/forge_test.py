"""forge_test.py SOURCE_DIR: workflows and the action can be read, their scripts are bash, and the files that they name exist.
.ci/nightly also validates them by the schemas of the forge."""

import pathlib
import re
import subprocess
import sys

try:
    import yaml
except ImportError:
    print("SKIPPED: no PyYAML; install python3-yaml")
    sys.exit(77)


def steps(file):
    content = yaml.safe_load(file.read_text())
    if "runs" in content:
        return content["runs"]["steps"], set(content["inputs"])
    return [step for job in content["jobs"].values() for step in job["steps"]], set()


def complaints(root, file):
    found, inputs = steps(file)
    for step in found:
        script = step.get("run", "")
        name = f"{file.name}: {step.get('name', script or step.get('uses'))}"
        if not script and "uses" not in step:
            yield f"{name}: neither run nor uses"
        checked = subprocess.run(["bash", "-n"], input=re.sub(r"\$\{\{.*?\}\}", "word", script), text=True, capture_output=True)
        if checked.returncode:
            yield f"{name}: {checked.stderr}"
        for part in re.findall(r"(?:^|\s)((?:\.ci|cmake)/[\w/]+)", script):
            if not (root / part).exists():
                yield f"{name}: there is no {part}"
        for target in re.findall(r"\bmake ([a-z ]+)", script):
            for word in target.split():
                if not re.search(rf"^{word}:", (root / "Makefile").read_text(), re.MULTILINE):
                    yield f"{name}: there is no make {word}"
        for word in re.findall(r"inputs\.([\w-]+)", str(step)):
            if word not in inputs:
                yield f"{name}: there is no input {word}"
    parts = re.search(r"part: \[(.*?)\]", file.read_text(), re.DOTALL)
    known = set(re.findall(r"^(\w+)\(\) \{", (root / ".ci/nightly").read_text(), re.MULTILINE))
    for part in parts[1].replace("\n", " ").split(",") if parts else []:
        if part.strip() not in known:
            yield f"{file.name}: .ci/nightly has no part {part.strip()}"


if __name__ == "__main__":
    root = pathlib.Path(sys.argv[1])
    files = [*(root / ".github/workflows").glob("*.yml"), root / "action.yml"]
    sys.exit("\n".join(line for file in files for line in complaints(root, file)) or 0)
