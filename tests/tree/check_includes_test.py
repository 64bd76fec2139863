"""The include checker finds what it is there to find, in a small tree with planted violations."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parent.parent.parent / "tools" / "check_includes.py"
TABLE = """
| module | purpose | may include | libraries |
| --- | --- | --- | --- |
| `core` | basics | - | tbb |
| `film` | pictures | core | OpenEXR |
| `shot` | settings | core film/settings.h | - |
"""


class CheckIncludes(unittest.TestCase):
    def check(self, files, table=TABLE):
        """Exit code and output for a tree with core/vec.h, film/settings.h, shot/shot.h and `files`."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "README.md").write_text(table, encoding="utf-8")
            tree = {"core/vec.h": "", "film/settings.h": "", "shot/shot.h": "", **files}
            for name, text in tree.items():
                (root / name).parent.mkdir(exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            done = subprocess.run([sys.executable, CHECKER, root], capture_output=True, text=True, check=False)
            return done.returncode, done.stdout

    def test_accepts_what_the_table_allows(self):
        code, _ = self.check({"film/a.cpp": '#include <vector>\n#include <OpenEXR/ImfHeader.h>\n#include "core/vec.h"\n',
                              "shot/a.cpp": '#include "film/settings.h"\n#include "shot/shot.h"\n'})
        self.assertEqual(code, 0)

    def test_finds_a_module_against_the_direction(self):
        code, output = self.check({"core/a.cpp": '\n#include "film/settings.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("core/a.cpp:2: core must not include film/settings.h", output)

    def test_finds_a_header_other_than_the_one_allowed(self):
        code, output = self.check({"film/image.h": "", "shot/a.cpp": '#include "film/image.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("shot must not include film/image.h", output)

    def test_finds_a_library_behind_another_wall(self):
        for header in ("tbb/parallel_for.h", "oneapi/tbb/info.h"):
            code, output = self.check({"film/a.cpp": f"#include <{header}>\n"})
            self.assertEqual(code, 1)
            self.assertIn("film must not include tbb", output)

    def test_finds_a_header_named_without_its_module(self):
        code, output = self.check({"film/a.cpp": '#include "settings.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("film/a.cpp:1", output)

    def test_finds_a_table_that_turns_round(self):
        code, output = self.check({}, TABLE.replace("| `core` | basics | - |", "| `core` | basics | film |"))
        self.assertEqual(code, 1)
        self.assertIn("not of a row above it", output)

    def test_finds_what_has_grown_too_large(self):
        code, output = self.check({"film/a.cpp": "//\n" * 401})
        self.assertEqual(code, 1)
        self.assertIn("film/a.cpp: 401 lines", output)
        code, output = self.check({f"film/a{i}.h": "" for i in range(26)})
        self.assertEqual(code, 1)
        self.assertIn("film: 27 files", output)
        code, output = self.check({f"film/a{i}.h": "//\n" * 400 for i in range(7)})
        self.assertEqual(code, 1)
        self.assertIn("2800 lines", output)

    def test_finds_a_folder_without_row(self):
        code, output = self.check({"extra/a.h": ""})
        self.assertEqual(code, 1)
        self.assertIn("extra: no row", output)


if __name__ == "__main__":
    unittest.main()
