# SPDX-License-Identifier: Apache-2.0
"""Every source file has a test of its name, or says where it is tested."""
import pathlib
import tempfile
import unittest

import rooms
import tested

TABLES = """
## Rooms
| level | folder | lives there | may include | sole user of |
|---|---|---|---|---|
| 0 | `base/` | - | – | – |
| 1 | `cli/` | - | all | – |
"""
FILES = {
    "docs/ARCHITECTURE.md": TABLES,
    "base/a.h": "int a();\n",
    "base/a.cpp": '#include "base/a.h"\n#include "base/b.h"\n',
    "base/b.h": "int b();\n",
    "base/b.cpp": '// Tested in tests/base/a_test.cpp.\n#include "base/b.h"\n',
    "base/plain.h": "struct Plain {};  // for (;;)\n",
    "cli/command.cpp": '// Tested in tests/cli/run_test.py.\n#include "cli/commands.h"\n',
    "cli/main.cpp": "",
    "tests/base/a_test.cpp": '#include "tests/base/helper.h"\n',
    "tests/base/helper.h": '#include "base/a.h"\n',
    "tests/cli/run_test.py": "",
}


class PlantedMistakes(unittest.TestCase):
    def found(self, **changes):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in (FILES | changes).items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            tree = tested.Tree(root)
            return tree.untested() + tree.misplaced()

    def test_none(self):
        self.assertEqual(self.found(), [])

    def test_a_source_without_a_test(self):
        self.assertEqual(len(self.found(**{"base/c.cpp": ""})), 1)
        self.assertEqual(len(self.found(**{"base/c.h": "if (x) y();\n"})), 1)

    def test_a_test_that_is_not_there(self):
        self.assertEqual(self.found(**{"base/c.cpp": "// Tested in tests/base/none_test.cpp.\n"}),
                         ["base/c.cpp: tests/base/none_test.cpp does not exist"])

    def test_a_test_that_does_not_use_it(self):
        line = "// Tested in tests/base/a_test.cpp.\n"
        self.assertEqual(self.found(**{"base/c.h": "", "base/c.cpp": line}),
                         ["base/c.cpp: tests/base/a_test.cpp does not use it"])
        self.assertEqual(self.found(**{"base/c.h": "", "base/c.cpp": line, "base/b.cpp": line + '#include "base/c.h"\n'}), [])
        self.assertEqual(len(self.found(**{"cli/b.h": "", "cli/b.cpp": line})), 1)
        self.assertEqual(len(self.found(**{"base/c.cpp": "// Tested in tests/cli/run_test.py.\n"})), 1)

    def test_a_line_beside_a_test_of_its_name(self):
        text = "// Tested in tests/base/a_test.cpp.\n" + FILES["base/a.cpp"]
        self.assertEqual(self.found(**{"base/a.cpp": text}),
                         ["base/a.cpp: tests/base/a_test.cpp is there; the line is not needed"])

    def test_a_test_outside_the_mirrored_folder(self):
        self.assertEqual(self.found(**{"tests/base/deep/x_test.cpp": ""}), ["tests/base/deep/x_test.cpp"])


class OurTree(unittest.TestCase):
    def test_every_source_is_tested(self):
        tree = tested.Tree(rooms.source_root())
        self.assertGreater(len(tree.sources()), 300)
        self.assertEqual(tree.untested(), [])

    def test_tests_mirror_the_tree(self):
        self.assertEqual(tested.Tree(rooms.source_root()).misplaced(), [])


if __name__ == "__main__":
    unittest.main()
