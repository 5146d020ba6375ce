# SPDX-License-Identifier: Apache-2.0
"""No module includes what docs/ARCHITECTURE.md does not let it include."""
import pathlib
import tempfile
import unittest

import modules

TABLES = """
## Modules
| level | folder | lives there | may include | sole user of |
|---|---|---|---|---|
| 0 | `base/` | - | – | TBB, xxHash |
| 1 | `geom/` | - | base | – |
| 2 | `render/` | - | base geom | Embree in `accel/` |
| 3 | `geom/host/` | - | base geom render | – |
| 4 | `cli/` | - | all | CLI11 |

### Shared libraries
| library | modules |
|---|---|
| fmt | all |
| Highway | geom |

### Inner layers
| folder | lives there | may include |
|---|---|---|
| `render/light/` | - | . |
| `render/accel/` | - | – |
| `render/path/` | - | accel |
"""


class PlantedIncludes(unittest.TestCase):
    def found(self, path, line):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / path
            file.parent.mkdir(parents=True)
            file.write_text(f"#pragma once\n  # include {line}\n")
            return modules.violations(pathlib.Path(folder), TABLES)

    def assert_allowed(self, path, line):
        self.assertEqual(self.found(path, line), [])

    def assert_refused(self, path, line):
        found = self.found(path, line)
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f"{path}:2: "), found)

    def test_modules(self):
        self.assert_allowed("geom/a.h", '"base/b.h"')
        self.assert_allowed("geom/io/a.cpp", '"geom/b.h"')
        self.assert_allowed("cli/a.cpp", '"render/path/b.h"')
        self.assert_refused("base/a.h", '"geom/b.h"')
        self.assert_refused("geom/io/a.cpp", '"render/b.h"')
        self.assert_refused("geom/a.cpp", '"tests/b.h"')
        self.assert_refused("geom/a.cpp", '"a.h"')

    def test_a_folder_with_a_level_of_its_own(self):
        self.assert_allowed("geom/host/a.h", '"render/b.h"')
        self.assert_allowed("geom/host/a.h", '"geom/host/b.h"')
        self.assert_allowed("geom/host/a.h", '"geom/io/b.h"')
        self.assert_allowed("cli/a.h", '"geom/host/b.h"')
        self.assert_refused("geom/a.h", '"geom/host/b.h"')
        self.assert_refused("render/a.h", '"geom/host/b.h"')

    def test_libraries(self):
        self.assert_allowed("base/a.cpp", "<tbb/parallel_for.h>")
        self.assert_refused("geom/a.cpp", "<tbb/parallel_for.h>")
        self.assert_allowed("render/accel/a.cpp", "<embree3/rtcore.h>")
        self.assert_refused("render/path/a.cpp", "<embree3/rtcore.h>")
        self.assert_refused("base/a.cpp", "<CLI/CLI.hpp>")
        self.assert_allowed("render/a.h", "<fmt/format.h>")
        self.assert_allowed("geom/a.cpp", "<hwy/highway.h>")
        self.assert_refused("render/a.cpp", "<hwy/highway.h>")
        self.assert_refused("render/a.cpp", "<yaml-cpp/yaml.h>")
        self.assert_refused("render/a.cpp", "<boost/any.hpp>")

    def test_system(self):
        for header in ("<vector>", "<string_view>", "<cmath>", "<sys/stat.h>", "<unistd.h>"):
            self.assert_allowed("base/a.cpp", header)

    def test_inner_layers(self):
        self.assert_allowed("render/path/a.h", '"render/accel/b.h"')
        self.assert_allowed("render/accel/fur/a.h", '"render/accel/b.h"')
        self.assert_allowed("render/a.h", '"render/path/b.h"')
        self.assert_refused("render/accel/a.h", '"render/path/b.h"')
        self.assert_refused("render/accel/fur/a.h", '"render/path/b.h"')
        self.assert_refused("render/accel/a.h", '"render/b.h"')
        self.assert_allowed("render/light/a.h", '"render/b.h"')
        self.assert_refused("render/light/a.h", '"render/accel/b.h"')
        self.assertEqual(self.found("render/new/a.h", '"base/b.h"'),
                         ["render/new/a.h: render/new is not in the table of inner layers"])

    def test_inner_layer_that_looks_upward(self):
        upward = TABLES.replace("| `render/accel/` | - | – |", "| `render/accel/` | - | path |")
        self.assertEqual(len(modules.violations(pathlib.Path("/nowhere"), upward)), 1)

    def test_table_that_looks_upward(self):
        upward = TABLES.replace("| base |", "| base render |")
        self.assertEqual(len(modules.violations(pathlib.Path("/nowhere"), upward)), 1)


class OurTree(unittest.TestCase):
    def test_keeps_to_the_tables(self):
        root = modules.source_root()
        text = (root / "docs" / "ARCHITECTURE.md").read_text()
        self.assertGreaterEqual(len(modules.read_modules(text)), 9)
        self.assertEqual(modules.violations(root, text), [])

    def test_every_folder_of_sources_is_known(self):
        root = modules.source_root()
        known = set(modules.read_modules((root / "docs" / "ARCHITECTURE.md").read_text()))
        known |= {"tests", "bench", "tools", "build", "cmake", "examples"}
        folders = {path.relative_to(root).parts[0] for path in root.glob("[a-z]*/*")
                   if path.suffix in (".h", ".cpp")}
        self.assertLessEqual(folders, known)


if __name__ == "__main__":
    unittest.main()
