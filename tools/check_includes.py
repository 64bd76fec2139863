#!/usr/bin/env python3
"""Fails when a file of src/ includes a module or a library that its row in src/README.md leaves out, or when a folder
or a file of src/ has grown too large to be read.

usage: check_includes.py SRC_FOLDER
"""

import pathlib
import re
import sys

ROW = re.compile(r"^\| `(\w+)` \|[^|]*\|([^|]*)\|([^|]*)\|\s*$")
INCLUDE = re.compile(r"^\s*#\s*include\s*([<\"])([^>\"]+)[>\"]", re.MULTILINE)
# Other names under which a library's headers are found.
ALIASES = {"oneapi": "tbb", "nanovdb": "openvdb", "tiny_gltf.h": "tinygltf", "xxhash.h": "xxhash"}
SOURCES = {".h", ".hpp", ".cpp", ".cc", ".inl"}
MOST_FILES, MOST_LINES, MOST_LINES_OF_FILE = 25, 2500, 400


def read_rules(readme):
    """Module name to (names it may include, libraries), in the order of the table."""
    rules = {}
    for line in readme.read_text(encoding="utf-8").splitlines():
        match = ROW.match(line)
        if match:
            name, modules, libraries = match.groups()
            split = lambda cell: [word for word in cell.split() if word != "-"]
            rules[name] = (split(modules), split(libraries))
    return rules


def check_table(root, rules):
    """The table itself: every folder has a row, every row a folder, and directions do not turn round."""
    folders = {path.name for path in root.iterdir() if path.is_dir()}
    for name in sorted(folders - rules.keys()):
        yield f"{name}: no row in README.md"
    for name in sorted(rules.keys() - folders):
        yield f"{name}: a row in README.md, but no such folder"
    above = set()
    for name, (modules, _) in rules.items():
        for module in modules:
            if module.split("/")[0] not in above:
                yield f"{name}: its row names {module}, which is not of a row above it"
        above.add(name)


def check_file(path, root, rules):
    """Complaints about one file's includes."""
    shown = path.relative_to(root)
    name = shown.parts[0]
    modules, libraries = rules[name]
    walled = {library for _, names in rules.values() for library in names}
    text = path.read_text(encoding="utf-8")
    for match in INCLUDE.finditer(text):
        quote, header = match.groups()
        line = text.count("\n", 0, match.start(1)) + 1
        first = header.split("/")[0]
        library = ALIASES.get(first, first)
        if library.startswith("Imf"):
            library = "OpenEXR"
        if first in rules:
            if first != name and first not in modules and header not in modules:
                yield f"{shown}:{line}: {name} must not include {header}"
        elif library in walled:
            if library not in libraries:
                yield f"{shown}:{line}: {name} must not include {library}"
        elif quote == '"' and not (root / header).exists():
            yield f"{shown}:{line}: write {header} from src/ on, with its module"


def check_sizes(root):
    """Folders of too many files or lines, and files of too many lines."""
    folders = {}
    for path in sorted(root.glob("*/**/*")):
        if path.suffix not in SOURCES:
            continue
        lines = len(path.read_text(encoding="utf-8").splitlines())
        if lines > MOST_LINES_OF_FILE:
            yield f"{path.relative_to(root)}: {lines} lines; {MOST_LINES_OF_FILE} at most"
        files, sum_of_lines = folders.get(path.parent, (0, 0))
        folders[path.parent] = (files + 1, sum_of_lines + lines)
    for folder, (files, lines) in folders.items():
        if files > MOST_FILES or lines > MOST_LINES:
            yield (f"{folder.relative_to(root)}: {files} files of {lines} lines; {MOST_FILES} files and "
                   f"{MOST_LINES} lines at most")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    rules = read_rules(root / "README.md")
    if not rules:
        sys.exit(f"{root}/README.md holds no table of modules")
    complaints = list(check_table(root, rules))
    for path in sorted(root.glob("*/**/*")):
        if path.suffix in SOURCES and path.relative_to(root).parts[0] in rules:
            complaints += check_file(path, root, rules)
    complaints += check_sizes(root)
    print("\n".join(complaints) if complaints else f"{len(rules)} modules keep to the table")
    sys.exit(1 if complaints else 0)


if __name__ == "__main__":
    main()
