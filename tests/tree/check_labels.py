"""Every test that CTest knows has exactly one of the labels `quick` and `slow`, and one that names its folder. Every
pattern that a folder lists as SLOW or TOGETHER is that of some test.

Usage: check_labels.py CTEST BUILD_FOLDER TESTS_FOLDER
"""

import collections
import fnmatch
import json
import pathlib
import re
import subprocess
import sys

FILTER = "--gtest_filter="


def stale_patterns(tests, folder):
    """One line for each pattern of SLOW or TOGETHER that no slow test of its folder has. Folders without one are left out."""
    names = collections.defaultdict(list)
    for test in tests:
        for argument in test["command"][1:]:
            if argument.startswith(FILTER):
                labels = [label for e in test["properties"] if e["name"] == "LABELS" for label in e["value"]]
                for label in labels if "slow" in labels else []:
                    names[label].append(argument[len(FILTER):])
    for lists in sorted(folder.glob("*/CMakeLists.txt")):
        known = names[lists.parent.name]
        for patterns in re.findall(r"\b(?:SLOW|TOGETHER) ((?:(?!TOGETHER)[^)])*)", lists.read_text(encoding="utf-8")):
            for pattern in patterns.split():
                if known and not any(fnmatch.fnmatchcase(name, pattern) for name in known):
                    yield f"{lists}: no test is called {pattern}"


def faults(tests):
    """One line for each test whose labels break the rule."""
    for test in tests:
        labels = []
        for entry in test.get("properties", []):
            if entry["name"] == "LABELS":
                labels = entry["value"]
        speeds = [label for label in labels if label in ("quick", "slow")]
        if len(speeds) != 1 or len(labels) != 2:
            yield f"{test['name']}: labels {labels}, expected a folder and one of quick and slow"
    counts = collections.Counter((test["name"], test["command"][0]) for test in tests)
    for (name, program), count in counts.items():
        if count > 1:
            yield f"{name} of {program}: known {count} times"


def main():
    ctest, folder, sources = sys.argv[1:]
    listed = subprocess.run([ctest, "--test-dir", folder, "--show-only=json-v1"], check=True, capture_output=True)
    # A program that is not built stands for its tests, and fails by itself.
    tests = [test for test in json.loads(listed.stdout)["tests"] if not test["name"].endswith("_NOT_BUILT")]
    found = list(faults(tests)) + list(stale_patterns(tests, pathlib.Path(sources)))
    print("\n".join(found) if found else f"{len(tests)} tests")
    return 1 if found or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
